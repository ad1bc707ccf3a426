#pragma once

#include <Eigen/Core>
#include <optional>

#include "report/json.hpp"

namespace chladni::report {

/// Numbers as a JSON array.
Json numbers_json(const Eigen::VectorXd& values);

/// A number, or null.
Json optional_json(const std::optional<double>& x);

/// Angular frequencies in rad/s as a JSON array in Hz.
Json frequencies_json(const Eigen::VectorXd& omega);

}  // namespace chladni::report
