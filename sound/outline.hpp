#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace chladni::sound {

/// Corners of a quadrilateral in the meridian plane (r, z), m, in order around it.
using Quadrilateral = std::array<Eigen::Vector2d, 4>;

/// A ball with its centre on the axis.
struct Ball {
  double z;       ///< m
  double radius;  ///< m
};

/// Cylindrical holes through the body parallel to the axis, at equal angles.
struct Holes {
  double circle_radius;  ///< radius of the circle of their centres, m
  double radius;         ///< m
  int count;
  double angle = 0.0;  ///< angle of the first hole, rad
};

/// The surface of a body: the union of solids of revolution without the holes.
struct Outline {
  std::vector<Quadrilateral> quadrilaterals;
  std::vector<Ball> balls = {};
  std::vector<Holes> holes = {};
  /// Radius of an infinitely thin disc in the plane z = 0 of a half space, m; 0 for none.
  double sheet_radius = 0.0;

  bool axisymmetric() const { return holes.empty(); }
};

/// The smallest ball with its centre on the axis that contains the outline.
Ball enclosing_ball(const Outline& outline);

/// Whether a point x (m) is inside the body or on its surface.
bool contains(const Outline& outline, const Eigen::Vector3d& x);

/// Whether each quadrilateral and ball is its own mirror image about z = 0. The test is sufficient
/// for symmetry, not necessary.
bool mirrored(const Outline& outline);

/// The smallest length that a mesh must resolve: the shortest edge of a quadrilateral or the
/// smallest hole diameter, m.
double smallest_length(const Outline& outline);

}  // namespace chladni::sound
