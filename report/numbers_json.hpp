#pragma once

#include <Eigen/Core>

#include "report/json.hpp"

namespace chladni::report {

/// Numbers as a JSON array.
Json numbers_json(const Eigen::VectorXd& values);

/// Angular frequencies in rad/s as a JSON array in Hz.
Json frequencies_json(const Eigen::VectorXd& omega);

}  // namespace chladni::report
