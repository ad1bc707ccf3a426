#include "sound/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace chladni::sound {
namespace {

using Eigen::Vector2d;

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

}  // namespace chladni::sound
