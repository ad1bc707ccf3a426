#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "squeal/assembly/part.hpp"

namespace chladni::squeal {

/// Equations of all parts on their joints, without contact: q'' + C q' + K q = f with the
/// constraints B q = 0 of the rigid joints.
struct JoinedParts {
  Eigen::MatrixXd K;               ///< [n x n] 1/s^2
  Eigen::MatrixXd C;               ///< [n x n] 1/s
  Eigen::MatrixXd B;               ///< [n_rigid x n] constraints, m or rad per unit of q
  std::vector<std::string> notes;  ///< notes about rigid joints that leave parts few motions
};

/// Joins the parts.
/// @param parts  parts that do not rotate, in the order of their coordinates
/// @throws chladni::Error naming the joint, for a set that a part does not have, sets of different
///         size, nodes farther apart than the span of the joint, and components that a body lacks
///         there or resists only by a numerical stiffness.
JoinedParts joined(std::span<const Part> parts, std::span<const JointOptions> joints);

/// Index of the first coordinate of each part, and the number of all coordinates at the end.
std::vector<Eigen::Index> first_coordinates(std::span<const Part> parts);

/// Index of the part with this name.
std::size_t part_index(std::span<const Part> parts, const std::string& name);

/// Orthonormal basis T of the motions with B T = 0; unit modal masses remain 1.
/// @return [n x n - rank(B)]
Eigen::MatrixXd null_space(const Eigen::MatrixXd& B);

}  // namespace chladni::squeal
