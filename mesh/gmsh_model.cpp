#include "mesh/gmsh_model.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/split_quadrilaterals.hpp"

namespace chladni::mesh {

namespace {

/// Gmsh is a process-wide singleton: one session at a time, closed also when an error leaves it.
class Session {
 public:
  Session() { gmsh::initialize(); }
  ~Session() { gmsh::finalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

void set_meshing_options()
{
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("General.AbortOnError", 0);
  // Frontal-Delaunay with Blossom recombination is nearly free of triangles on discs. Algorithm 8
  // (frontal-Delaunay for quads) crashes in Gmsh 4.8.4 on a circle of 60 arcs.
  gmsh::option::setNumber("Mesh.Algorithm", 6);
  gmsh::option::setNumber("Mesh.RecombineAll", 1);
  gmsh::option::setNumber("Mesh.RecombinationAlgorithm", 1);
  gmsh::option::setNumber("Mesh.ElementOrder", 1);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
}

/// For each node of our lattice order, its place in Gmsh's node order of this element type.
std::vector<int> lattice_permutation(int type, Shape shape, int order)
{
  std::string name;
  int dimension = 0;
  int gmsh_order = 0;
  int n_nodes = 0;
  int n_primary = 0;
  std::vector<double> local;  // parent coordinates, `dimension` for each node
  gmsh::model::mesh::getElementProperties(type, name, dimension, gmsh_order, n_nodes, local,
                                          n_primary);
  const bool from_minus_one = shape != Shape::triangle;
  std::map<std::pair<int, int>, int> place;  // (row, column) -> Gmsh's index
  for (int k = 0; k < n_nodes; ++k) {
    const auto column = [&](double x) {
      return static_cast<int>(std::lround((from_minus_one ? (x + 1.0) / 2.0 : x) * order));
    };
    const int row = dimension == 2 ? column(local[2 * k + 1]) : 0;
    place[{row, column(local[dimension * k])}] = k;
  }
  std::vector<int> permutation;
  for (const auto& [lattice_point, k] : place) permutation.push_back(k);
  return permutation;
}

std::vector<std::pair<int, int>> physical_entities(int dimension)
{
  std::vector<std::pair<int, int>> tags;
  gmsh::model::getPhysicalGroups(tags, dimension);
  return tags;
}

std::string physical_name(int dimension, int tag)
{
  std::string name;
  gmsh::model::getPhysicalName(dimension, tag, name);
  return name.empty() ? fmt::format("{}", tag) : name;
}

using NodeIndex = std::unordered_map<std::size_t, int>;

NodeIndex read_nodes(Mesh& mesh)
{
  std::vector<std::size_t> tags;
  std::vector<double> coordinates;
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  std::vector<std::size_t> order(tags.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return tags[i]; });
  NodeIndex index;
  for (const std::size_t i : order) {
    if (!index.emplace(tags[i], mesh.n_nodes()).second) continue;
    mesh.node_numbers.push_back(static_cast<std::int64_t>(tags[i]));
    mesh.positions.push_back({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
  }
  return index;
}

/// (dimension, tag) of the entities with elements -> index of their physical group in mesh.groups:
/// surfaces (the first group counts) and the curves of the line groups.
using GroupOfEntity = std::map<std::pair<int, int>, int>;

GroupOfEntity read_groups(Mesh& mesh, const NodeIndex& index,
                          const std::vector<std::string>& line_groups)
{
  GroupOfEntity group_of_entity;
  for (int dimension = 0; dimension <= 2; ++dimension) {
    for (const auto& [dim, tag] : physical_entities(dimension)) {
      std::vector<std::size_t> tags;
      std::vector<double> coordinates;
      gmsh::model::mesh::getNodesForPhysicalGroup(dim, tag, tags, coordinates);
      Group group{.name = physical_name(dim, tag), .dimension = dim, .nodes = {}};
      for (const std::size_t t : tags) group.nodes.push_back(index.at(t));
      std::ranges::sort(group.nodes);
      group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()), group.nodes.end());
      const bool is_line_group =
          dim == 1 && std::ranges::find(line_groups, group.name) != line_groups.end();
      if (dim == 2 || is_line_group) {
        std::vector<int> entities;
        gmsh::model::getEntitiesForPhysicalGroup(dim, tag, entities);
        for (const int e : entities) {
          group_of_entity.emplace(std::pair{dim, e}, static_cast<int>(mesh.groups.size()));
        }
      }
      mesh.groups.push_back(std::move(group));
    }
  }
  return group_of_entity;
}

ElementBlock& block_of(Mesh& mesh, int type)
{
  std::string name;
  int dimension = 0;
  int order = 0;
  int n_nodes = 0;
  int n_primary = 0;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(type, name, dimension, order, n_nodes, local, n_primary);
  const Shape shape = dimension == 1   ? Shape::line
                      : n_primary == 3 ? Shape::triangle
                                       : Shape::quadrilateral;
  const int complete = shape == Shape::line       ? order + 1
                       : shape == Shape::triangle ? (order + 1) * (order + 2) / 2
                                                  : (order + 1) * (order + 1);
  if (n_nodes != complete) {
    throw Error(
        fmt::format("the mesh has \"{}\" elements; Chladni reads complete elements only: "
                    "set Mesh.SecondOrderIncomplete = 0 in Gmsh",
                    name));
  }
  const auto same = [&](const ElementBlock& b) { return b.shape == shape && b.order == order; };
  const auto it = std::ranges::find_if(mesh.blocks, same);
  if (it != mesh.blocks.end()) return *it;
  mesh.blocks.push_back(ElementBlock{.shape = shape,
                                     .order = order,
                                     .nodes_per_element = n_nodes,
                                     .numbers = {},
                                     .nodes = {},
                                     .group = {}});
  return mesh.blocks.back();
}

/// @param entity  dimension and tag
void read_elements(Mesh& mesh, const NodeIndex& index, std::pair<int, int> entity, int group)
{
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, numbers, nodes, entity.first, entity.second);
  for (std::size_t t = 0; t < types.size(); ++t) {
    ElementBlock& block = block_of(mesh, types[t]);
    const std::vector<int> permutation = lattice_permutation(types[t], block.shape, block.order);
    for (std::size_t e = 0; e < numbers[t].size(); ++e) {
      block.numbers.push_back(static_cast<std::int64_t>(numbers[t][e]));
      block.group.push_back(group);
      for (const int k : permutation) {
        block.nodes.push_back(index.at(nodes[t][e * permutation.size() + k]));
      }
    }
  }
}

/// Keeps only the nodes that an element uses, in their order.
void drop_unused_nodes(Mesh& mesh)
{
  std::vector<int> renumbered(mesh.positions.size(), -1);
  for (const ElementBlock& block : mesh.blocks) {
    for (const int node : block.nodes) renumbered[node] = 0;
  }
  int n = 0;
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] < 0) continue;
    mesh.positions[n] = mesh.positions[i];
    mesh.node_numbers[n] = mesh.node_numbers[i];
    renumbered[i] = n++;
  }
  mesh.positions.resize(n);
  mesh.node_numbers.resize(n);
  for (ElementBlock& block : mesh.blocks) {
    for (int& node : block.nodes) node = renumbered[node];
  }
  for (Group& group : mesh.groups) {
    for (int& node : group.nodes) node = renumbered[node];
    std::erase(group.nodes, -1);
  }
}

Mesh current_model(const std::vector<std::string>& line_groups)
{
  Mesh mesh;
  const NodeIndex index = read_nodes(mesh);
  GroupOfEntity group_of_entity = read_groups(mesh, index, line_groups);
  std::vector<std::pair<int, int>> surfaces;
  gmsh::model::getEntities(surfaces, 2);
  for (const auto& surface : surfaces) group_of_entity.emplace(surface, -1);  // in no group
  for (const auto& [entity, group] : group_of_entity) {
    read_elements(mesh, index, entity, group);
  }
  if (mesh.blocks.empty()) {
    throw Error(
        "the mesh has no elements: neither triangles and quads nor lines of a beam's group");
  }
  drop_unused_nodes(mesh);
  return mesh;
}

bool has_elements()
{
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types);
  return !types.empty();
}

}  // namespace

Mesh mesh_with_gmsh(const std::function<void()>& build, int order,
                    const std::vector<std::string>& line_groups)
{
  const Session session;
  try {
    set_meshing_options();
    build();
    if (!has_elements()) {
      gmsh::model::mesh::generate(2);
      if (order > 1) gmsh::model::mesh::setOrder(order);
    }
    return split_flat_corners(current_model(line_groups));
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(fmt::format("Gmsh: {}", e.what()));
  } catch (const std::string& text) {  // the 4.8 API throws strings in places
    throw Error(fmt::format("Gmsh: {}", text));
  }
}

}  // namespace chladni::mesh
