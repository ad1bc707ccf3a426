#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::linear {

/// The coordinates of two symmetric matrices in sets that neither couples with the others, each set
/// ascending, by its first coordinate. What is coupled by round-off is coupled.
std::vector<std::vector<Eigen::Index>> decoupled_coordinates(const Eigen::MatrixXd& K,
                                                             const Eigen::MatrixXd& M);

}  // namespace chladni::linear
