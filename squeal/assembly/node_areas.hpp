#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// The area of a face around the z axis that each node stands for: what is nearer to it than to any
/// other node, within the outline. The outline is the convex hull of the nodes in (x, y), which of
/// a straight plate is the plate itself, or that in (r, R theta), R the mean radius, which of a
/// sector of a ring is the sector; the smaller one is taken, and distances in its plane. A grid of
/// circles and radii gets the areas of the trapezoidal rule there.
/// @param radii   [n] m
/// @param angles  [n] rad, at most half a turn apart
/// @return [n] m^2; zeros where all nodes lie on one line or circle
Eigen::VectorXd node_areas(const Eigen::VectorXd& radii, const Eigen::VectorXd& angles);

}  // namespace chladni::squeal
