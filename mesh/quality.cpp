#include "mesh/quality.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/error.hpp"
#include "mesh/tangents.hpp"
#include "mesh/vectors.hpp"

namespace chladni::mesh {

namespace {

using Corners = std::vector<Vector>;

constexpr double degree = std::numbers::pi / 180.0;

Vector mean(const Vector& a, const Vector& b)
{
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

/// Between 0 and pi; that of a zero vector is 0.
double angle(const Vector& a, const Vector& b)
{
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

Corners corners(const Mesh& mesh, const ElementBlock& block, int element)
{
  const int p = block.order;
  const int last = block.nodes_per_element - 1;
  const std::vector<int> places = block.shape == Shape::triangle
                                      ? std::vector<int>{0, p, last}
                                      : std::vector<int>{0, p, last, last - p};
  Corners x;
  for (const int k : places) x.push_back(mesh.positions[block.element_nodes(element)[k]]);
  return x;
}

/// An area vector a_1 x a_2 at a node, and its scale |a_1| |a_2|; on a triangle the greatest such
/// product of two of the three directions of its edges.
struct AreaVector {
  Vector n;
  double scale;
};

std::vector<AreaVector> area_vectors(const Mesh& mesh, const ElementBlock& block, int element,
                                     const NodeDerivatives& d)
{
  const auto nodes = block.element_nodes(element);
  std::vector<AreaVector> vectors;
  for (int i = 0; i < d.n_nodes; ++i) {
    Vector a_1{}, a_2{};
    for (int j = 0; j < d.n_nodes; ++j) {
      for (std::size_t c = 0; c < 3; ++c) {
        a_1[c] += d.first[i * d.n_nodes + j] * mesh.positions[nodes[j]][c];
        a_2[c] += d.second[i * d.n_nodes + j] * mesh.positions[nodes[j]][c];
      }
    }
    const double third = block.shape == Shape::triangle ? norm(minus(a_2, a_1)) : 0.0;
    const double scale = std::max({norm(a_1) * norm(a_2), norm(a_1) * third, norm(a_2) * third});
    vectors.push_back({.n = cross(a_1, a_2), .scale = scale});
  }
  return vectors;
}

/// Signed by the mean normal, which a folded part of the element turns against.
double scaled_jacobian(const std::vector<AreaVector>& vectors, Shape shape)
{
  Vector sum{};
  for (const AreaVector& v : vectors)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += v.n[c];
  const double best = shape == Shape::triangle ? std::sqrt(3.0) / 2.0 : 1.0;
  double least = std::numeric_limits<double>::infinity();
  for (const AreaVector& v : vectors) {
    // Tangents of 1e-12 of an element's size are none.
    const double sine = v.scale > 1e-24 * norm(sum) ? norm(v.n) / v.scale : 0.0;
    least = std::min(least, dot(v.n, sum) > 0.0 ? sine : -sine);
  }
  return std::min(least / best, 1.0);
}

double aspect_ratio(const Corners& x)
{
  if (x.size() == 4) {
    const double a = norm(minus(mean(x[1], x[2]), mean(x[0], x[3])));
    const double b = norm(minus(mean(x[2], x[3]), mean(x[0], x[1])));
    return std::max(a, b) / std::min(a, b);
  }
  const double longest =
      std::max({norm(minus(x[1], x[0])), norm(minus(x[2], x[1])), norm(minus(x[0], x[2]))});
  const double twice_area = norm(cross(minus(x[1], x[0]), minus(x[2], x[0])));
  return longest * longest / twice_area * std::sqrt(3.0) / 2.0;
}

double warp(const Corners& x)
{
  if (x.size() == 3) return 0.0;
  const auto normal = [&](int a, int b, int c) {
    return cross(minus(x[b], x[a]), minus(x[c], x[a]));
  };
  return std::max(angle(normal(0, 1, 2), normal(0, 2, 3)),
                  angle(normal(1, 2, 3), normal(1, 3, 0))) /
         degree;
}

double skew(const Corners& x)
{
  const std::size_t n = x.size();
  const double ideal = n == 3 ? std::numbers::pi / 3.0 : std::numbers::pi / 2.0;
  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double at = angle(minus(x[(i + 1) % n], x[i]), minus(x[(i + n - 1) % n], x[i]));
    worst = std::max({worst, (at - ideal) / (std::numbers::pi - ideal), (ideal - at) / ideal});
  }
  return worst;
}

}  // namespace

std::vector<ElementQuality> quality(const Mesh& mesh)
{
  std::vector<ElementQuality> elements;
  for (const ElementBlock& block : mesh.blocks) {
    if (block.shape == Shape::line) continue;
    const NodeDerivatives derivatives = node_derivatives(block.shape, block.order);
    for (int e = 0; e < block.n_elements(); ++e) {
      const Corners x = corners(mesh, block, e);
      elements.push_back({.number = block.numbers[e],
                          .scaled_jacobian = scaled_jacobian(
                              area_vectors(mesh, block, e, derivatives), block.shape),
                          .aspect_ratio = aspect_ratio(x),
                          .warp = warp(x),
                          .skew = skew(x)});
    }
  }
  return elements;
}

std::vector<std::int64_t> unusable(const std::vector<ElementQuality>& elements)
{
  std::vector<std::int64_t> numbers;
  for (const ElementQuality& e : elements) {
    // Round-off of a corner of 180 degrees is no angle; so does not-a-number fail.
    if (!(e.scaled_jacobian > 1e-9)) numbers.push_back(e.number);
  }
  return numbers;
}

void check_usable(const Mesh& mesh, const std::string& name)
{
  std::vector<std::int64_t> numbers = unusable(quality(mesh));
  if (numbers.empty()) return;
  const std::size_t n = numbers.size();
  numbers.resize(std::min<std::size_t>(n, 10));
  throw Error(
      fmt::format("{}: {} elements are degenerate or folded over (their Jacobian is not positive): "
                  "{}{}; repair "
                  "or refine the mesh there",
                  name, n, fmt::join(numbers, ", "), n > 10 ? ", ..." : ""));
}

}  // namespace chladni::mesh
