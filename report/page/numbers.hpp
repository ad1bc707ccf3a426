#pragma once

#include <Eigen/Core>
#include <span>

#include "report/json.hpp"

namespace chladni::report {

/// A number for a picture: six digits; null when not finite.
Json rounded(double x);

/// A list of them.
Json rounded(std::span<const double> x);
Json rounded(const Eigen::VectorXd& x);

/// The rows of a matrix as a list of lists.
Json rounded_rows(const Eigen::MatrixXd& rows);

/// A list of texts.
Json texts(const std::vector<std::string>& words);

}  // namespace chladni::report
