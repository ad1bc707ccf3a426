#include "mesh/rings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

struct Nearest {
  int node;
  double distance;
};

Nearest nearest_node(const Mesh& mesh, double x, double y)
{
  Nearest best{.node = -1, .distance = std::numeric_limits<double>::infinity()};
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const double d = std::hypot(mesh.positions[i][0] - x, mesh.positions[i][1] - y);
    if (d < best.distance) best = {.node = i, .distance = d};
  }
  return best;
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
    const Nearest nearest = nearest_node(mesh, x, y);
    if (nearest.distance > tolerance) {
      throw Error(fmt::format(
          "ring \"{}\": no node of the mesh at radius {} m, angle {:.6g} degrees (the nearest is "
          "{:.3g} m away); put {} points at equal angles from the x axis on that circle",
          ring.name, ring.radius, angle * 180.0 / std::numbers::pi, nearest.distance, ring.nodes));
    }
    mesh.positions[nearest.node][0] = x;
    mesh.positions[nearest.node][1] = y;
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
