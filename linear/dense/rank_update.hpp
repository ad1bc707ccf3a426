#pragma once

#include <Eigen/Core>

namespace chladni::linear {

/// A <- A - U S for a U of few columns, and the sums of squares of the columns of what is left. The
/// work is that of reading A once; Eigen's products would pack U and S anew each time.
/// @param U  [n x k]
/// @param S  [k x m]
/// @param A  [n x m] by columns, without gaps
/// @return [m]
Eigen::VectorXd subtract_of_low_rank(const Eigen::MatrixXd& U, const Eigen::MatrixXd& S, double* A);

}  // namespace chladni::linear
