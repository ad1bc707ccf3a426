#pragma once

#include <Eigen/Core>
#include <random>

namespace chladni::linear {

/// Numbers between -1 and 1, the same for each size.
inline Eigen::MatrixXd random_matrix(int n_rows, int n_columns)
{
  std::mt19937 generator(n_rows + 1000 * n_columns);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(n_rows, n_columns, [&] { return uniform(generator); });
}

}  // namespace chladni::linear
