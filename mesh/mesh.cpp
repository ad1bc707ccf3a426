#include "mesh/mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

/// Fowler-Noll-Vo hash, variant 1a, 64 bits.
class Fnv1a {
 public:
  template <typename T>
  void add(std::span<const T> values)
  {
    for (const std::byte b : std::as_bytes(values))
      state_ = (state_ ^ std::to_integer<std::uint64_t>(b)) * 1099511628211ULL;
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 14695981039346656037ULL;
};

}  // namespace

const Group& find_group(const Mesh& mesh, const std::string& name)
{
  const auto it = std::ranges::find(mesh.groups, name, &Group::name);
  if (it != mesh.groups.end()) return *it;
  std::vector<std::string> names;
  for (const Group& g : mesh.groups) names.push_back(g.name);
  throw Error(fmt::format("the mesh has no group \"{}\"; its groups are: {}", name,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

void drop_unused_nodes(Mesh& mesh, std::span<const std::string> kept)
{
  std::vector<int> renumbered(mesh.positions.size(), -1);
  for (const ElementBlock& block : mesh.blocks)
    for (const int node : block.nodes) renumbered[node] = 0;
  for (const Group& group : mesh.groups)
    if (std::ranges::find(kept, group.name) != kept.end())
      for (const int node : group.nodes) renumbered[node] = 0;
  int n = 0;
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] < 0) continue;
    mesh.positions[n] = mesh.positions[i];
    mesh.node_numbers[n] = mesh.node_numbers[i];
    renumbered[i] = n++;
  }
  mesh.positions.resize(n);
  mesh.node_numbers.resize(n);
  for (ElementBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = renumbered[node];
  for (Group& group : mesh.groups) {
    for (int& node : group.nodes) node = renumbered[node];
    std::erase(group.nodes, -1);
  }
}

std::string checksum(const Mesh& mesh)
{
  Fnv1a hash;
  hash.add(std::span(mesh.positions));
  for (const ElementBlock& block : mesh.blocks) hash.add(std::span(block.nodes));
  if (mesh.sectors.count > 1) hash.add(std::span(&mesh.sectors.count, 1));
  return fmt::format("{:016x}", hash.value());
}

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
    if (i == found.node || std::hypot(p[0] - x[0], p[1] - x[1]) > found.distance + tolerance)
      continue;
    throw Error(fmt::format(
        "ring \"{}\": nodes {} and {} both stand on its circle, at z = {:.6g} and {:.6g} m; say "
        "which with z = ... in the ring",
        ring.name, mesh.node_numbers[found.node], mesh.node_numbers[i], x[2], p[2]));
  }
}

/// Where the nodes of a ring belong, and those that are nearest.
struct Place {
  double angle, x, y;
  Nearest nearest;
};

std::vector<Place> places_of(const Mesh& mesh, const RingOptions& ring)
{
  std::vector<Place> places;
  for (int i = 0; i < ring.nodes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / ring.nodes;
    const double x = ring.radius * std::cos(angle), y = ring.radius * std::sin(angle);
    places.push_back({.angle = angle, .x = x, .y = y, .nearest = nearest_node(mesh, x, y, ring.z)});
  }
  return places;
}

void refuse_missing(const std::vector<Place>& places, const Place& missing, const RingOptions& ring,
                    double tolerance)
{
  const auto is_there = [&](const Place& place) { return place.nearest.distance <= tolerance; };
  throw Error(fmt::format(
      "ring \"{}\": {} of its {} nodes are there; no node of the mesh is within {:.2g} m of radius "
      "{} m, angle {:.6g} degrees (the nearest is {:.3g} m away); put {} points at equal angles "
      "from the x axis on that circle",
      ring.name, std::ranges::count_if(places, is_there), ring.nodes, tolerance, ring.radius,
      missing.angle * 180.0 / std::numbers::pi, missing.nearest.distance, ring.nodes));
}

/// The places that have a node: all of them, or, of a sector, those inside and at its edges.
/// @throws chladni::Error when a place has no node in any sector.
std::vector<Place> occupied(const Mesh& mesh, const std::vector<Place>& places,
                            const RingOptions& ring, double tolerance)
{
  if (ring.nodes % mesh.sectors.count != 0) {
    throw Error(
        fmt::format("ring \"{}\": its {} nodes do not repeat in {} sectors; take a multiple",
                    ring.name, ring.nodes, mesh.sectors.count));
  }
  const int n_each = ring.nodes / mesh.sectors.count;
  std::vector<bool> is_there(static_cast<std::size_t>(n_each), false);
  std::vector<Place> found;
  for (int i = 0; i < ring.nodes; ++i) {
    const Place& place = places[static_cast<std::size_t>(i)];
    if (place.nearest.distance > tolerance) continue;
    is_there[static_cast<std::size_t>(i % n_each)] = true;
    found.push_back(place);
  }
  const auto missing = std::ranges::find(is_there, false);
  if (missing != is_there.end()) {
    refuse_missing(places, places[static_cast<std::size_t>(missing - is_there.begin())], ring,
                   tolerance);
  }
  return found;
}

Group ring_group(Mesh& mesh, const RingOptions& ring)
{
  constexpr double of_spacing = 1e-3;  // no element is bent by that; a file of 8 digits needs 1e-7
  constexpr double round_off = 1e-9;   // of Gmsh's arcs and of a file with 16 digits
  const double tolerance = of_spacing * 2.0 * std::numbers::pi * ring.radius / ring.nodes;
  const std::vector<Place> places = occupied(mesh, places_of(mesh, ring), ring, tolerance);
  Group group{.name = ring.name, .dimension = 0, .nodes = {}};
  double largest_move = 0.0;
  for (const Place& place : places) {
    const int node = place.nearest.node;
    if (!ring.z) check_only_one(mesh, ring, place.nearest, tolerance);
    mesh.positions[node][0] = place.x;
    mesh.positions[node][1] = place.y;
    if (ring.z) mesh.positions[node][2] = *ring.z;
    largest_move = std::max(largest_move, place.nearest.distance);
    group.nodes.push_back(node);
  }
  if (largest_move > round_off * ring.radius) {
    mesh.notes.push_back(
        fmt::format("ring \"{}\": its nodes were moved onto the circle, by {:.2g} m at most",
                    ring.name, largest_move));
  }
  return group;
}

}  // namespace

void add_rings(Mesh& mesh, std::span<const RingOptions> rings)
{
  for (const RingOptions& ring : rings) mesh.groups.push_back(ring_group(mesh, ring));
}

}  // namespace chladni::mesh
