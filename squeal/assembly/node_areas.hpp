#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// The area of a face around the z axis that each node stands for: what is nearer to it than to any
/// other node, with distances taken in (r, R theta), R the mean radius. The outline is the convex
/// hull of the nodes in (r, theta), which for a sector of a ring is the sector itself: a grid of
/// circles and radii gets the areas of the trapezoidal rule, and all areas sum to that of the
/// sector.
/// @param radii   [n] m
/// @param angles  [n] rad, less than half a turn apart
/// @return [n] m^2; zeros where all nodes lie on one line or circle
Eigen::VectorXd node_areas(const Eigen::VectorXd& radii, const Eigen::VectorXd& angles);

}  // namespace chladni::squeal
