#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>

#include "common/error.hpp"
#include "mesh/gmsh/circles.hpp"
#include "mesh/gmsh/entity_groups.hpp"
#include "mesh/gmsh/files.hpp"

namespace chladni::mesh {

namespace {

constexpr std::array<const char*, 3> prefixes{"point_", "curve_", "surface_"};

std::string label_of(const Entity& entity)
{
  std::string label;
  gmsh::model::getEntityName(entity.first, entity.second, label);
  return label;
}

/// "Shapes/part/face" is found by its last part too.
bool has_label(const Entity& entity, const std::string& name)
{
  const std::string label = label_of(entity);
  return label == name || label.ends_with("/" + name);
}

std::string list(const std::vector<Entity>& entities)
{
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(entities.size(), 20); ++i) {
    const std::string label = label_of(entities[i]);
    text += fmt::format("{}{}{}", i == 0 ? "" : ", ", entity_name(entities[i]),
                        label.empty() ? "" : fmt::format(" ({})", label));
  }
  return text + (entities.size() > 20 ? ", ..." : "");
}

void check_ungrouped(const EntityGroup& group, const Entity& entity)
{
  if (entity.first != 2) return;
  std::vector<int> tags;
  gmsh::model::getPhysicalGroupsForEntity(entity.first, entity.second, tags);
  if (tags.empty()) return;
  std::string name;
  gmsh::model::getPhysicalName(entity.first, tags.front(), name);
  throw Error(fmt::format("group \"{}\": {} belongs to the group \"{}\" already", group.name,
                          entity_name(entity), name.empty() ? std::to_string(tags.front()) : name));
}

/// A .msh may list entities of which it holds no element.
bool is_without_elements(const Entity& entity)
{
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, entity.first, entity.second);
  return types.empty();
}

bool is_meshed()
{
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types);
  return !types.empty();
}

void add_group_of_each(int dimension)
{
  std::vector<Entity> groups;
  gmsh::model::getPhysicalGroups(groups, dimension);
  if (!groups.empty()) return;
  std::vector<Entity> entities;
  gmsh::model::getEntities(entities, dimension);
  if (is_meshed()) std::erase_if(entities, is_without_elements);
  for (const Entity& e : entities) add_physical_group(dimension, {e.second}, entity_name(e));
}

}  // namespace

std::string entity_name(const Entity& entity)
{
  return prefixes.at(entity.first) + std::to_string(entity.second);
}

std::vector<Entity> find_entities(const EntityGroup& group)
{
  std::vector<Entity> all;
  gmsh::model::getEntities(all);
  std::erase_if(all, [](const Entity& e) { return e.first > 2; });
  std::vector<Entity> found;
  for (const std::string& name : group.entities) {
    const std::size_t before = found.size();
    for (const Entity& entity : all)
      if (entity_name(entity) == name || has_label(entity, name)) found.push_back(entity);
    if (found.size() > before) continue;
    std::ranges::reverse(all);  // surfaces first
    throw Error(fmt::format("group \"{}\": there is no entity \"{}\"; there are: {}", group.name,
                            name, list(all)));
  }
  const auto other = [&](const Entity& e) { return e.first != found.front().first; };
  if (std::ranges::any_of(found, other))
    throw Error(fmt::format("group \"{}\" mixes points, curves and surfaces", group.name));
  return found;
}

void add_entity_group(const EntityGroup& group, const std::vector<Entity>& entities)
{
  std::vector<int> tags;
  for (const Entity& entity : entities) {
    check_ungrouped(group, entity);
    tags.push_back(entity.second);
  }
  std::ranges::sort(tags);
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  add_physical_group(entities.front().first, tags, group.name);
}

void add_groups_of_each_entity()
{
  add_group_of_each(2);
  add_group_of_each(1);
}

void add_entity_groups(const MeshOptions& options)
{
  for (const EntityGroup& group : options.groups) add_entity_group(group, find_entities(group));
  add_groups_of_each_entity();
}

}  // namespace chladni::mesh
