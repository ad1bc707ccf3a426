#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "common/error.hpp"
#include "mesh/gmsh/entity_groups.hpp"
#include "mesh/gmsh/files.hpp"

namespace chladni::mesh {

namespace {

namespace occ = gmsh::model::occ;

constexpr double mm = 1e-3;  // m

std::vector<Entity> entities_of(int dimension)
{
  std::vector<Entity> entities;
  gmsh::model::getEntities(entities, dimension);
  return entities;
}

void check_shells(const std::string& file)
{
  if (const auto solids = entities_of(3); !solids.empty()) {
    throw Error(
        fmt::format("mesh file {} holds {} solids; Chladni meshes shells: export the "
                    "mid-surfaces as surfaces (shell or faces)",
                    file, solids.size()));
  }
  if (entities_of(2).empty()) throw Error(fmt::format("mesh file {} has no surface", file));
}

/// Arcs between the nodes of a ring.
std::vector<Entity> add_ring_arcs(const RingOptions& ring)
{
  std::vector<Entity> arcs;
  for (int i = 0; i < ring.nodes; ++i) {
    const double step = 2.0 * std::numbers::pi / ring.nodes;
    arcs.emplace_back(1, occ::addCircle(0.0, 0.0, ring.z.value_or(0.0) / mm, ring.radius / mm, -1,
                                        i * step, (i + 1) * step));
  }
  return arcs;
}

/// Makes all surfaces meet in common curves, with the rings' arcs among them.
/// @return what became of each surface and curve of the file
std::map<Entity, std::vector<Entity>> join(const std::vector<RingOptions>& rings)
{
  std::vector<Entity> objects = entities_of(2);
  const std::vector<Entity> curves = entities_of(1);
  objects.insert(objects.end(), curves.begin(), curves.end());
  std::vector<Entity> tools;
  for (const RingOptions& ring : rings) {
    const std::vector<Entity> arcs = add_ring_arcs(ring);
    tools.insert(tools.end(), arcs.begin(), arcs.end());
  }
  std::vector<Entity> all;
  std::vector<std::vector<Entity>> parts;
  occ::fragment(objects, tools, all, parts);
  occ::synchronize();
  std::map<Entity, std::vector<Entity>> became;
  for (std::size_t i = 0; i < objects.size(); ++i) became[objects[i]] = parts[i];
  return became;
}

/// Across the box of the body, from corner to corner, m.
double size_of_body()
{
  std::array<double, 3> low{}, high{};
  gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
  return mm * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

void set_sizes(double element_size)
{
  constexpr double most_across = 1e4;
  const double least = size_of_body() / most_across;
  if (element_size < least) {
    throw Error(fmt::format(
        "mesh.element_size = {} m is too small for a body of {:.3g} m; take {:.1g} m or more",
        element_size, most_across * least, least));
  }
  gmsh::option::setNumber("Mesh.MeshSizeMax", element_size / mm);
  gmsh::option::setNumber("Mesh.MeshSizeMin", 0.02 * element_size / mm);
  // A cubic edge of 90 degrees folds its element over.
  gmsh::option::setNumber("Mesh.MinimumElementsPerTwoPi", 12);
  gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", 1);
}

/// Groups of the file's entities, as what became of them; one for each surface and curve that is
/// left, unless groups of surfaces or curves are given.
void add_groups(const MeshOptions& options, const std::vector<std::vector<Entity>>& of_groups,
                const std::map<Entity, std::vector<Entity>>& became)
{
  std::array<bool, 3> given{};
  for (std::size_t i = 0; i < options.groups.size(); ++i) {
    std::vector<Entity> parts;
    for (const Entity& entity : of_groups[i]) {
      const auto& p = became.at(entity);
      parts.insert(parts.end(), p.begin(), p.end());
    }
    if (parts.empty()) continue;
    given.at(parts.front().first) = true;
    add_entity_group(options.groups[i], parts);
  }
  for (const auto& [entity, parts] : became) {
    if (given.at(entity.first) || parts.empty()) continue;
    add_entity_group({.name = entity_name(entity), .entities = {}}, parts);
  }
}

}  // namespace

std::vector<std::string> open_step(const MeshOptions& options)
{
  gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
  gmsh::model::add("step");
  std::vector<Entity> imported;
  occ::importShapes(*options.file, imported, false, "step");
  occ::synchronize();
  check_shells(*options.file);
  std::vector<std::vector<Entity>> of_groups;
  for (const EntityGroup& group : options.groups) of_groups.push_back(find_entities(group));
  add_groups(options, of_groups, join(options.rings));
  if (options.element_size) set_sizes(*options.element_size);
  return {};
}

}  // namespace chladni::mesh
