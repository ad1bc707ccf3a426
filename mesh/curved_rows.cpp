#include "mesh/curved_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace chladni::mesh {

namespace {

struct Polar {
  double r, angle, z;
};

Polar polar(const std::array<double, 3>& x, const CurvedRow& row)
{
  const double dx = x[0] - row.centre[0], dy = x[1] - row.centre[1];
  return {.r = std::hypot(dx, dy), .angle = std::atan2(dy, dx), .z = x[2]};
}

using PolarCorners = std::array<Polar, 3>;

/// The corners of a triangle of the row, their angles without a jump; nothing for another one.
std::optional<PolarCorners> corners_in(const Mesh& mesh, const std::array<int, 3>& nodes,
                                       const CurvedRow& row)
{
  PolarCorners corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = polar(mesh.positions[nodes[i]], row);
    const double off =
        std::min(std::abs(corners[i].r - row.inner), std::abs(corners[i].r - row.outer));
    if (off > 1e-9 * row.outer) return std::nullopt;
    const double turn = corners[i].angle - corners[0].angle;
    corners[i].angle -= 2.0 * std::numbers::pi * std::round(turn / (2.0 * std::numbers::pi));
  }
  return corners;
}

std::array<double, 3> curved_place(const PolarCorners& corners,
                                   const std::array<double, 3>& weights, const CurvedRow& row)
{
  Polar p{};
  for (std::size_t i = 0; i < 3; ++i) {
    p.r += weights[i] * corners[i].r;
    p.angle += weights[i] * corners[i].angle;
    p.z += weights[i] * corners[i].z;
  }
  return {row.centre[0] + p.r * std::cos(p.angle), row.centre[1] + p.r * std::sin(p.angle), p.z};
}

void bend(Mesh& mesh, const ElementBlock& block, int element, const CurvedRow& row)
{
  const std::span<const int> nodes = block.element_nodes(element);
  const int order = block.order;
  const auto corners = corners_in(mesh, {nodes[0], nodes[order], nodes.back()}, row);
  if (!corners) return;
  std::size_t node = 0;
  for (int j = 0; j <= order; ++j) {
    for (int i = 0; i + j <= order; ++i, ++node) {
      const double r = double(i) / order, s = double(j) / order;
      const bool is_corner = i == order || j == order || i + j == 0;
      if (!is_corner)
        mesh.positions[nodes[node]] = curved_place(*corners, {1.0 - r - s, r, s}, row);
    }
  }
}

}  // namespace

void bend_triangles(Mesh& mesh, std::span<const CurvedRow> rows)
{
  for (const ElementBlock& block : mesh.blocks) {
    if (block.shape != Shape::triangle || block.order < 2) continue;
    for (int e = 0; e < block.n_elements(); ++e)
      for (const CurvedRow& row : rows) bend(mesh, block, e, row);
  }
}

}  // namespace chladni::mesh
