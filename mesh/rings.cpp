#include "mesh/rings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

struct Nearest {
  int node;
  double distance;
};

/// @param z of the node, if that matters
Nearest nearest_node(const Mesh& mesh, double x, double y, const std::optional<double>& z)
{
  Nearest best{.node = -1, .distance = std::numeric_limits<double>::infinity()};
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const auto& p = mesh.positions[i];
    const double d = std::hypot(p[0] - x, p[1] - y, z ? p[2] - *z : 0.0);
    if (d < best.distance) best = {.node = i, .distance = d};
  }
  return best;
}

/// @throws chladni::Error when another node has the same x and y, and only z could tell them apart.
void check_only_one(const Mesh& mesh, const RingOptions& ring, const Nearest& found,
                    double tolerance)
{
  const auto& x = mesh.positions[found.node];
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const auto& p = mesh.positions[i];
    if (i == found.node || std::hypot(p[0] - x[0], p[1] - x[1]) > found.distance + tolerance) {
      continue;
    }
    throw Error(fmt::format(
        "ring \"{}\": nodes {} and {} both stand on its circle, at z = {:.6g} and {:.6g} m; say "
        "which with z = ... in the ring",
        ring.name, mesh.node_numbers[found.node], mesh.node_numbers[i], x[2], p[2]));
  }
}

Group ring_group(Mesh& mesh, const RingOptions& ring)
{
  // Round-off of Gmsh's arcs and of a file with 16 digits; far below any element size.
  const double tolerance = 1e-9 * ring.radius;
  Group group{.name = ring.name, .dimension = 0, .nodes = {}};
  for (int i = 0; i < ring.nodes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / ring.nodes;
    const double x = ring.radius * std::cos(angle);
    const double y = ring.radius * std::sin(angle);
    const Nearest nearest = nearest_node(mesh, x, y, ring.z);
    if (nearest.distance > tolerance) {
      throw Error(fmt::format(
          "ring \"{}\": no node of the mesh at radius {} m, angle {:.6g} degrees (the nearest is "
          "{:.3g} m away); put {} points at equal angles from the x axis on that circle",
          ring.name, ring.radius, angle * 180.0 / std::numbers::pi, nearest.distance, ring.nodes));
    }
    if (!ring.z) check_only_one(mesh, ring, nearest, tolerance);
    mesh.positions[nearest.node][0] = x;
    mesh.positions[nearest.node][1] = y;
    if (ring.z) mesh.positions[nearest.node][2] = *ring.z;
    group.nodes.push_back(nearest.node);
  }
  return group;
}

}  // namespace

void add_rings(Mesh& mesh, std::span<const RingOptions> rings)
{
  for (const RingOptions& ring : rings) mesh.groups.push_back(ring_group(mesh, ring));
}

}  // namespace chladni::mesh
