#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// Area of a face around the z axis that belongs to each node: the part of the outline that is
/// nearer to this node than to any other. The outline is the convex hull of the nodes in (x, y),
/// which is exact for a straight plate, or in (r, R theta) with the mean radius R, which is exact
/// for a sector of a ring; the smaller hull is taken, and distances are measured in its plane. A
/// grid of circles and radii gets the areas of the trapezoidal rule.
/// @param radii   [n] m
/// @param angles  [n] rad, less than half a turn apart
/// @return [n] m^2; zeros when all nodes lie on one line or circle
Eigen::VectorXd node_areas(const Eigen::VectorXd& radii, const Eigen::VectorXd& angles);

}  // namespace chladni::squeal
