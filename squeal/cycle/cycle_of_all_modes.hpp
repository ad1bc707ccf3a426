#pragma once

#include <Eigen/Core>

#include "squeal/models/flexible_disc.hpp"

namespace chladni::squeal {

/// The states of a brake with some modes of a body as states of the same brake with all of them,
/// where the modes left out do not move.
/// @param x  [size of `few` x n]
/// @return [size of `all` x n]
Eigen::MatrixXd with_all_modes(const FlexibleDisc& few, const FlexibleDisc& all,
                               const Eigen::MatrixXd& x);

}  // namespace chladni::squeal
