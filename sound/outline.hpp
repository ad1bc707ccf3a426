#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace chladni::sound {

/// Corners of a quadrilateral in the meridian plane (r, z), m, in the order of its circumference.
using Quadrilateral = std::array<Eigen::Vector2d, 4>;

/// A ball around a point of the axis.
struct Ball {
  double z;       ///< m
  double radius;  ///< m
};

/// Cylindrical holes through the body along the axis, at equal angles.
struct Holes {
  double circle_radius;  ///< m, of their centres
  double radius;         ///< m
  int count;
  double angle = 0.0;  ///< of the first, rad
};

/// The surface of a body: that of the union of solids of revolution, less the holes.
struct Outline {
  std::vector<Quadrilateral> quadrilaterals;
  std::vector<Ball> balls = {};
  std::vector<Holes> holes = {};
  /// m, of an infinitely thin disc in the plane z = 0 of a half space; 0 for none.
  double sheet_radius = 0.0;

  bool axisymmetric() const { return holes.empty(); }
};

/// Smallest sphere about a point of the axis that holds the outline.
Ball enclosing_ball(const Outline& outline);

/// Whether a point (m) is inside the body or on its surface.
bool contains(const Outline& outline, const Eigen::Vector3d& x);

/// Whether the solid is its own mirror image at z = 0.
bool mirrored(const Outline& outline);

/// The shortest edge of a quadrilateral, m: what a mesh has to resolve.
double smallest_length(const Outline& outline);

}  // namespace chladni::sound
