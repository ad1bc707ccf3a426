#include "squeal/assembly/node_areas.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace chladni::squeal {
namespace {

using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

double cross(const Point& a, const Point& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// One chain of the hull of points in ascending order, without its last point.
template <class Points>
Polygon chain_of(const Points& points)
{
  Polygon chain;
  for (const Point& p : points) {
    while (chain.size() > 1 &&
           cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0.0)
      chain.pop_back();
    chain.push_back(p);
  }
  chain.pop_back();
  return chain;
}

/// The convex hull, counterclockwise.
/// Source: Andrew, Information Processing Letters 9 (1979) 216.
Polygon hull_of(Polygon points)
{
  std::ranges::sort(points, [](const Point& a, const Point& b) {
    return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
  });
  Polygon hull = chain_of(points);
  std::ranges::reverse(points);
  const Polygon back = chain_of(points);
  hull.insert(hull.end(), back.begin(), back.end());
  return hull;
}

/// The part of a convex polygon that is nearer to `own` than to `other`.
Polygon nearer(const Polygon& polygon, const Point& own, const Point& other)
{
  const Point middle = 0.5 * (own + other), away = other - own;
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double d_a = away.dot(a - middle), d_b = away.dot(b - middle);
    if (d_a <= 0.0) part.push_back(a);
    if ((d_a < 0.0 && d_b > 0.0) || (d_a > 0.0 && d_b < 0.0))
      part.push_back(a + d_a / (d_a - d_b) * (b - a));
  }
  return part;
}

double area_of(const Polygon& polygon)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += 0.5 * cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

/// The integral of x over a polygon.
double moment_of(const Polygon& polygon)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += (a[0] + b[0]) * cross(a, b) / 6.0;
  }
  return sum;
}

/// Nodes in a plane, in which a polygon has some area.
struct Plane {
  Polygon points, hull;
  std::function<double(const Polygon&)> area;

  double whole() const { return area(hull); }
};

Plane plane_of(Polygon points, std::function<double(const Polygon&)> area)
{
  Polygon hull = hull_of(points);
  return {std::move(points), std::move(hull), std::move(area)};
}

/// What of the hull is nearer to each point than to the others.
Eigen::VectorXd cells(const Plane& plane)
{
  Eigen::VectorXd areas(std::ssize(plane.points));
  for (std::size_t i = 0; i < plane.points.size(); ++i) {
    Polygon cell = plane.hull;
    for (std::size_t j = 0; j < plane.points.size() && !cell.empty(); ++j)
      if (j != i) cell = nearer(cell, plane.points[i], plane.points[j]);
    areas[static_cast<Eigen::Index>(i)] = plane.area(cell);
  }
  return areas;
}

}  // namespace

Eigen::VectorXd node_areas(const Eigen::VectorXd& radii, const Eigen::VectorXd& angles)
{
  const double R = radii.mean();
  Polygon polar, straight;
  for (Eigen::Index i = 0; i < radii.size(); ++i) {
    polar.emplace_back(radii[i], R * angles[i]);
    straight.emplace_back(radii[i] * std::cos(angles[i]), radii[i] * std::sin(angles[i]));
  }
  if (polar.size() < 3) return Eigen::VectorXd::Zero(radii.size());
  // The integral of r dr dtheta.
  const Plane of_sector =
      plane_of(std::move(polar), [R](const Polygon& p) { return moment_of(p) / R; });
  const Plane of_plate = plane_of(std::move(straight), area_of);
  const Plane& taken = of_plate.whole() < of_sector.whole() ? of_plate : of_sector;
  // On a line rounding alone leaves some area.
  if (!(taken.whole() > 1e-9 * R * R)) return Eigen::VectorXd::Zero(radii.size());
  return cells(taken);
}

}  // namespace chladni::squeal
