#pragma once

#include "sound/outline.hpp"

namespace chladni::sound {

/// A straight piece of the middle surface of a shell of revolution, seen in the meridian plane.
struct MidLine {
  Eigen::Vector2d from, to;  ///< (r, z), m
  double thickness;          ///< m

  double length() const { return (to - from).norm(); }
  Eigen::Vector2d tangent() const { return (to - from) / length(); }
  /// The tangent turned by a quarter from r to z: +z for a line that leads outwards.
  Eigen::Vector2d normal() const { return {-tangent()[1], tangent()[0]}; }
};

/// What the hole in the middle of a disc is like.
enum class Hub {
  closed,  ///< filled by something that does not move
  open
};

/// A body of thick shells of revolution.
struct ThickBody {
  std::vector<MidLine> lines;
  Outline outline;
};

/// @throws chladni::Error when there is no line, or one without length or thickness, or one that
///         crosses the axis.
ThickBody thick_body(const std::vector<MidLine>& lines, Hub hub,
                     const std::vector<Holes>& holes = {});

/// Where a point of the meridian plane belongs in the body.
struct Place {
  int line;
  double s;     ///< along the line, from its beginning, m; within it
  double zeta;  ///< across the line, m
};

/// The nearest piece of the middle surface, in units of its thickness.
Place nearest_place(const std::vector<MidLine>& lines, const Eigen::Vector2d& x);

/// Whether a point of the meridian plane has a piece of the middle surface both above and below it,
/// as a vane between the two rings of a ventilated disc has.
bool lies_between(const std::vector<MidLine>& lines, const Eigen::Vector2d& x);

}  // namespace chladni::sound
