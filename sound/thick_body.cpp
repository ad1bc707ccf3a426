#include "sound/thick_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.hpp"

namespace chladni::sound {
namespace {

using Eigen::Vector2d;

void check(const MidLine& line)
{
  const bool thick = line.thickness > 0.0 && line.length() > 0.0;
  if (thick && line.from[0] >= 0.0 && line.to[0] >= 0.0) return;
  throw Error(fmt::format(
      "sound: the piece of the middle surface from (r, z) = ({:.6g}, {:.6g}) m to ({:.6g}, {:.6g}) "
      "m with thickness {:.6g} m must have a length, a thickness and r >= 0",
      line.from[0], line.from[1], line.to[0], line.to[1], line.thickness));
}

/// The innermost line, led on to the axis at its own height.
MidLine plug(const std::vector<MidLine>& lines)
{
  const auto inmost = std::ranges::min_element(
      lines, {}, [](const MidLine& line) { return std::min(line.from[0], line.to[0]); });
  const Vector2d end = inmost->from[0] < inmost->to[0] ? inmost->from : inmost->to;
  return {.from = Vector2d(0.0, end[1]), .to = end, .thickness = inmost->thickness};
}

Quadrilateral thick(const MidLine& line)
{
  const Vector2d half = 0.5 * line.thickness * line.normal();
  Quadrilateral q{line.from - half, line.to - half, line.to + half, line.from + half};
  for (Vector2d& x : q) x[0] = std::max(x[0], 0.0);
  return q;
}

}  // namespace

ThickBody thick_body(const std::vector<MidLine>& lines, Hub hub, const std::vector<Holes>& holes)
{
  if (lines.empty()) throw Error("sound: the outline has no piece of a middle surface");
  std::ranges::for_each(lines, check);
  ThickBody body{lines, {.quadrilaterals = {}, .balls = {}, .holes = holes}};
  std::vector<MidLine> solid = lines;
  const MidLine middle = plug(lines);
  if (hub == Hub::closed && middle.length() > 0.0) solid.push_back(middle);
  // A flat disc with its hub is one rectangle, without an edge between the two.
  if (solid.size() == 2 && hub == Hub::closed && lines[0].from[1] == lines[0].to[1]) {
    solid = {{.from = middle.from,
              .to = lines[0].from[0] < lines[0].to[0] ? lines[0].to : lines[0].from,
              .thickness = lines[0].thickness}};
  }
  for (const MidLine& line : solid) body.outline.quadrilaterals.push_back(thick(line));
  return body;
}

Place nearest_place(const std::vector<MidLine>& lines, const Vector2d& x)
{
  Place nearest{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const MidLine& line = lines[i];
    const double s = std::clamp((x - line.from).dot(line.tangent()), 0.0, line.length());
    const double distance = (x - line.from - s * line.tangent()).norm() / line.thickness;
    if (distance >= least) continue;
    least = distance;
    nearest = {static_cast<int>(i), s, (x - line.from).dot(line.normal())};
  }
  return nearest;
}

bool lies_between(const std::vector<MidLine>& lines, const Vector2d& x)
{
  constexpr double placement = 1e-6;  // of a line's length
  bool above = false, below = false;
  for (const MidLine& line : lines) {
    const double width = line.to[0] - line.from[0];
    if (std::abs(width) < placement * line.length()) continue;  // along the axis
    const double part = (x[0] - line.from[0]) / width;
    if (part < -placement || part > 1.0 + placement) continue;
    const double height = line.from[1] + part * (line.to[1] - line.from[1]);
    above |= height > x[1];
    below |= height < x[1];
  }
  return above && below;
}

}  // namespace chladni::sound
