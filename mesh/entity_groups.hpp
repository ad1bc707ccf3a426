#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Dimension and tag of a point, curve or surface in Gmsh.
using Entity = std::pair<int, int>;

/// "surface_3"
std::string entity_name(const Entity& entity);

/// The entities that a group names by "surface_3" or by label; all of one dimension.
/// @throws chladni::Error listing those that exist.
std::vector<Entity> find_entities(const EntityGroup& group);

/// @throws chladni::Error when a surface has a group already.
void add_entity_group(const EntityGroup& group, const std::vector<Entity>& entities);

/// A group for each surface where no surface has one, and likewise for curves.
void add_groups_of_each_entity();

}  // namespace chladni::mesh
