#include "sound/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/error.hpp"

namespace chladni::sound {

using Eigen::Vector2d;

namespace {

/// Relative to the size of the body.
constexpr double placement = 1e-9;

double cross(const Vector2d& a, const Vector2d& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

bool inside(const Quadrilateral& q, const Vector2d& x)
{
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d edge = q[(i + 1) % 4] - q[i];
    const double side = cross(edge, x - q[i]) / edge.squaredNorm();
    left += side > -placement;
    right += side < placement;
  }
  return left == 4 || right == 4;
}

bool in_hole(const Holes& holes, const Eigen::Vector3d& x)
{
  for (int i = 0; i < holes.count; ++i) {
    const double angle = holes.angle + 2.0 * std::numbers::pi * i / holes.count;
    const Vector2d centre = holes.circle_radius * Vector2d(std::cos(angle), std::sin(angle));
    if ((x.head<2>() - centre).norm() < holes.radius) return true;
  }
  return false;
}

/// Largest distance of the outline from (0, z).
double radius_about(const Outline& outline, double z)
{
  double radius = 0.0;
  for (const Quadrilateral& q : outline.quadrilaterals)
    for (const Vector2d& x : q) radius = std::max(radius, std::hypot(x[0], x[1] - z));
  for (const Ball& ball : outline.balls)
    radius = std::max(radius, std::abs(ball.z - z) + ball.radius);
  return std::max(radius, std::hypot(outline.sheet_radius, z));
}

}  // namespace

Ball enclosing_ball(const Outline& outline)
{
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Quadrilateral& q : outline.quadrilaterals)
    for (const Vector2d& x : q) low = std::min(low, x[1]), high = std::max(high, x[1]);
  for (const Ball& ball : outline.balls)
    low = std::min(low, ball.z - ball.radius), high = std::max(high, ball.z + ball.radius);
  if (outline.sheet_radius > 0.0) low = std::min(low, 0.0), high = std::max(high, 0.0);
  // The radius is convex over z: search by thirds.
  while (high - low > 1e-12 * radius_about(outline, high)) {
    const double third = (high - low) / 3.0;
    if (radius_about(outline, low + third) < radius_about(outline, high - third))
      high -= third;
    else
      low += third;
  }
  const double z = 0.5 * (low + high);
  return {.z = std::abs(z) < placement * radius_about(outline, 0.0) ? 0.0 : z,
          .radius = radius_about(outline, z)};
}

bool contains(const Outline& outline, const Eigen::Vector3d& x)
{
  if (std::ranges::any_of(outline.holes, [&](const Holes& h) { return in_hole(h, x); }))
    return false;
  const Vector2d rz(std::hypot(x[0], x[1]), x[2]);
  const auto in_quadrilateral = [&](const Quadrilateral& q) { return inside(q, rz); };
  const auto in_ball = [&](const Ball& b) { return (rz - Vector2d(0.0, b.z)).norm() <= b.radius; };
  return std::ranges::any_of(outline.quadrilaterals, in_quadrilateral) ||
         std::ranges::any_of(outline.balls, in_ball);
}

bool mirrored(const Outline& outline)
{
  // Every part has its own image: enough for discs, and never wrong.
  const double limit = placement * enclosing_ball(outline).radius;
  const auto same = [&](const Quadrilateral& q) {
    return std::ranges::all_of(q, [&](const Vector2d& x) {
      return std::ranges::any_of(
          q, [&](const Vector2d& y) { return std::hypot(x[0] - y[0], x[1] + y[1]) < limit; });
    });
  };
  return std::ranges::all_of(outline.quadrilaterals, same) &&
         std::ranges::all_of(outline.balls, [&](const Ball& b) { return std::abs(b.z) < limit; });
}

double smallest_length(const Outline& outline)
{
  double length = enclosing_ball(outline).radius;
  for (const Quadrilateral& q : outline.quadrilaterals)
    for (std::size_t i = 0; i < 4; ++i) length = std::min(length, (q[(i + 1) % 4] - q[i]).norm());
  for (const Holes& holes : outline.holes) length = std::min(length, 2.0 * holes.radius);
  return length;
}

namespace {

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
