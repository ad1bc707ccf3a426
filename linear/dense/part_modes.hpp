#pragma once

#include <vector>

#include "linear/dense/decoupled_coordinates.hpp"
#include "linear/dense/eigenmodes.hpp"

namespace chladni::linear {

/// Modes of coordinates that are coupled to no others.
struct PartModes {
  std::vector<Eigen::Index> coordinates;
  Eigenmodes modes;  ///< in these coordinates
};

/// eigenmodes() of coordinates of a problem whose largest 1 / lambda is `mu_of_whole` or more: what
/// is round-off beside that has no mass.
Eigenmodes eigenmodes_of_part(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                              const Eigen::MatrixXd& R, double mu_of_whole,
                              double orthonormal_to = 1e-8);

/// The modes of all parts in n coordinates.
Eigenmodes merged(const std::vector<PartModes>& parts, Eigen::Index n);

}  // namespace chladni::linear
