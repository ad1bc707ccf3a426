#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "squeal/assembly/part.hpp"

namespace chladni::squeal {

/// The coordinates q of all parts on their joints, without contact:
/// q'' + C q' + K q = f with B q = 0 for what is rigidly joined.
struct JoinedParts {
  Eigen::MatrixXd K;               ///< [n x n] 1/s^2
  Eigen::MatrixXd C;               ///< [n x n] 1/s
  Eigen::MatrixXd B;               ///< [n_rigid x n] m or rad per unit of q
  std::vector<std::string> notes;  ///< of rigid joints that leave parts few motions
};

/// @param parts  that do not turn, whose coordinates follow one another
/// @throws chladni::Error naming the joint for a set that a part does not have, sets of different
///         size, nodes farther apart than the joint spans, and components that a body lacks there
///         or resists by a numerical stiffness alone.
JoinedParts joined(std::span<const Part> parts, std::span<const JointOptions> joints);

/// The first coordinate of each part, and their number at the end.
std::vector<Eigen::Index> first_coordinates(std::span<const Part> parts);

/// Index of the part of this name.
std::size_t part_index(std::span<const Part> parts, const std::string& name);

/// An orthonormal basis T of the motions that B allows, B T = 0: masses stay 1.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& B);

}  // namespace chladni::squeal
