#pragma once

#include <Eigen/Core>
#include <optional>

#include "report/json.hpp"

namespace chladni::report {

/// Numbers as a JSON array.
Json numbers_json(const Eigen::VectorXd& values);

/// The number, or null when there is none.
Json optional_json(const std::optional<double>& x);

/// Angular frequencies in rad/s as a JSON array of frequencies in Hz.
Json frequencies_json(const Eigen::VectorXd& omega);

}  // namespace chladni::report
