#include "mesh/extrude.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh/element_types.hpp"

namespace chladni::mesh {

namespace {

/// The places of the inner nodes of each edge of a surface element, around it.
std::vector<std::vector<int>> edge_places(const ElementBlock& block)
{
  const std::vector<int> places = corners_first(block.shape, block.order);
  const int n = n_corners(block.shape), inner = block.order - 1;
  std::vector<std::vector<int>> edges;
  for (int edge = 0; edge < n; ++edge) {
    const auto first = places.begin() + n + edge * inner;
    edges.emplace_back(first, first + inner);
    // Those of a quadrilateral run with its coordinates.
    if (block.shape == Shape::quadrilateral && edge >= 2) std::ranges::reverse(edges.back());
  }
  return edges;
}

/// The nodes of the planes in which solids have some, made where they are first asked for.
class Planes {
 public:
  Planes(const Mesh& flat, const Extrusion& extrusion, int order, Mesh& mesh)
      : flat_(flat),
        extrusion_(extrusion),
        n_planes_(extrusion.layers * order + 1),
        node_(std::size_t(flat.n_nodes()) * std::size_t(n_planes_), -1),
        mesh_(mesh)
  {}

  int n_planes() const { return n_planes_; }
  /// -1 where there is none.
  int at(int node, int plane) const { return node_[place(node, plane)]; }
  int node(int of, int plane)
  {
    int& node = node_[place(of, plane)];
    if (node >= 0) return node;
    node = mesh_.n_nodes();
    const Vector& x = flat_.positions[std::size_t(of)];
    mesh_.positions.push_back({x[0], x[1], height(plane)});
    mesh_.node_numbers.push_back(node + 1);
    return node;
  }

 private:
  std::size_t place(int node, int plane) const
  {
    return std::size_t(node) * std::size_t(n_planes_) + std::size_t(plane);
  }
  double height(int plane) const
  {
    return std::lerp(extrusion_.from, extrusion_.to, double(plane) / (n_planes_ - 1));
  }

  const Mesh& flat_;
  const Extrusion& extrusion_;
  int n_planes_;
  std::vector<int> node_;
  Mesh& mesh_;
};

bool points_down(const Mesh& flat, std::span<const int> nodes, const std::vector<int>& corners)
{
  const auto x = [&](std::size_t k) { return flat.positions[std::size_t(nodes[corners[k]])]; };
  return cross(minus(x(1), x(0)), minus(x(corners.size() - 1), x(0)))[2] < 0.0;
}

/// The nodes of the solid between the planes `low` and `high`, of which the second may be below.
std::vector<int> solid_between(const ElementBlock& block, std::span<const int> nodes,
                               std::array<int, 2> between, Planes& planes)
{
  const auto [low, high] = between;
  const std::vector<int> corners = corner_places(block);
  const std::vector<std::vector<int>> edges = edge_places(block);
  std::vector<int> solid;
  for (const int plane : {low, high})
    for (const int corner : corners) solid.push_back(planes.node(nodes[corner], plane));
  for (const int plane : {low, high})
    for (const std::vector<int>& edge : edges)
      for (const int place : edge) solid.push_back(planes.node(nodes[place], plane));
  const int step = high > low ? 1 : -1;
  for (const int corner : corners)
    for (int plane = low + step; plane != high; plane += step)
      solid.push_back(planes.node(nodes[corner], plane));
  return solid;
}

void add_block(const Mesh& flat, const ElementBlock& block, int layers, Planes& planes, Mesh& mesh)
{
  const Shape shape = block.shape == Shape::triangle ? Shape::wedge : Shape::hexahedron;
  const int p = block.order;
  ElementBlock solids{.shape = shape,
                      .order = p,
                      .nodes_per_element = static_cast<int>(solid_nodes(shape, p).size()),
                      .numbers = {},
                      .nodes = {},
                      .group = {}};
  const std::vector<int> corners = corner_places(block);
  std::int64_t number = 1;
  for (const ElementBlock& other : mesh.blocks) number += other.n_elements();
  for (int layer = 0; layer < layers; ++layer) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::span<const int> nodes = block.element_nodes(e);
      std::array between{layer * p, (layer + 1) * p};
      if (points_down(flat, nodes, corners)) std::swap(between[0], between[1]);
      const std::vector<int> solid = solid_between(block, nodes, between, planes);
      solids.nodes.insert(solids.nodes.end(), solid.begin(), solid.end());
      solids.numbers.push_back(number++);
      solids.group.push_back(block.group[std::size_t(e)]);
    }
  }
  mesh.blocks.push_back(std::move(solids));
}

/// The nodes above those of a group, in the planes from `first` to `last`.
Group nodes_above(const std::vector<int>& nodes, std::array<int, 2> range, const Planes& planes)
{
  Group group{.name = {}, .dimension = 2, .nodes = {}};
  for (const int node : nodes)
    for (int plane = range[0]; plane <= range[1]; ++plane)
      if (const int above = planes.at(node, plane); above >= 0) group.nodes.push_back(above);
  std::ranges::sort(group.nodes);
  return group;
}

}  // namespace

Mesh extruded(const Mesh& flat, const Extrusion& extrusion, std::span<const RingOptions> rings)
{
  Mesh mesh;
  mesh.notes = flat.notes;
  mesh.made_by = flat.made_by;
  int order = 1;
  for (const ElementBlock& block : flat.blocks) order = std::max(order, block.order);
  Planes planes(flat, extrusion, order, mesh);
  for (const ElementBlock& block : flat.blocks)
    add_block(flat, block, extrusion.layers, planes, mesh);
  std::vector<int> all(std::size_t(flat.n_nodes()));
  for (int i = 0; i < flat.n_nodes(); ++i) all[std::size_t(i)] = i;
  const int top = planes.n_planes() - 1;
  mesh.sectors.count = flat.sectors.count;
  for (const auto& [low, high] : flat.sectors.pairs)
    for (int plane = 0; plane <= top; ++plane)
      if (planes.at(low, plane) >= 0)
        mesh.sectors.pairs.push_back({planes.at(low, plane), planes.at(high, plane)});
  for (const Group& group : flat.groups) {
    Group above = nodes_above(group.nodes, {0, top}, planes);
    above.name = group.name;
    above.dimension = group.dimension + 1;
    mesh.groups.push_back(std::move(above));
  }
  for (const auto& [name, plane] : {std::pair{"bottom_face", 0}, std::pair{"top_face", top}}) {
    mesh.groups.push_back(nodes_above(all, {plane, plane}, planes));
    mesh.groups.back().name = name;
  }
  std::vector<RingOptions> placed(rings.begin(), rings.end());
  for (RingOptions& ring : placed) ring.z = ring.z.value_or(extrusion.to);
  add_rings(mesh, placed);
  return mesh;
}

}  // namespace chladni::mesh
