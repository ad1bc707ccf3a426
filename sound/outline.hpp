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

/// A straight piece of the middle surface of a shell of revolution, in the meridian plane.
struct MidLine {
  Eigen::Vector2d from, to;  ///< (r, z), m
  double thickness;          ///< m

  double length() const { return (to - from).norm(); }
  Eigen::Vector2d tangent() const { return (to - from) / length(); }
  /// The tangent turned by 90 degrees from r to z: +z for a line that goes outward.
  Eigen::Vector2d normal() const { return {-tangent()[1], tangent()[0]}; }
};

/// Condition of the hole in the middle of a disc.
enum class Hub {
  closed,  ///< filled by a part that does not move
  open
};

/// A body that consists of thick shells of revolution.
struct ThickBody {
  std::vector<MidLine> lines;
  Outline outline;
};

/// The body with these middle lines.
/// @throws chladni::Error when there is no line, or a line has no length, has no thickness or
///         crosses the axis.
ThickBody thick_body(const std::vector<MidLine>& lines, Hub hub,
                     const std::vector<Holes>& holes = {});

/// Position of a point of the meridian plane in the body.
struct Place {
  int line;     ///< index of the line
  double s;     ///< coordinate along the line from its beginning, m, between 0 and its length
  double zeta;  ///< coordinate across the line, m
};

/// The position relative to the nearest line, with distances in units of the line's thickness.
/// @param x  (r, z), m
Place nearest_place(const std::vector<MidLine>& lines, const Eigen::Vector2d& x);

/// Whether there are lines both above and below a point (r, z) of the meridian plane, as for a vane
/// between the two rings of a ventilated disc.
bool lies_between(const std::vector<MidLine>& lines, const Eigen::Vector2d& x);

}  // namespace chladni::sound
