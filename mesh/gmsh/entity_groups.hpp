#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Dimension and tag of a point, curve or surface in Gmsh.
using Entity = std::pair<int, int>;

/// The name of an entity, as "surface_3".
std::string entity_name(const Entity& entity);

/// The entities of a group, named as "surface_3" or by their label; all have one dimension.
/// @throws chladni::Error listing those that exist.
std::vector<Entity> find_entities(const EntityGroup& group);

/// Adds a physical group of the entities.
/// @throws chladni::Error when a surface already belongs to a group.
void add_entity_group(const EntityGroup& group, const std::vector<Entity>& entities);

/// Adds a group for each surface if no surface has one, and for each curve if no curve has one.
void add_groups_of_each_entity();

}  // namespace chladni::mesh
