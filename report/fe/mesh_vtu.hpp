#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/fe/mesh_groups.hpp"

namespace chladni::report {

/// The mesh with its groups as the text of a .vtu file. Its cells are the elements, then the edges
/// of curve groups and the nodes of point groups. Cell arrays are the element number (0 for an edge
/// or a node), the index of the group in the mesh (-1 for none), and "group NAME", which is 1 for
/// the cells of that group. The "group NAME" arrays are left out when they would take more than 30
/// MB.
/// @param parts  of the groups of the mesh, from group_parts
std::string mesh_vtu(const mesh::Mesh& mesh, const std::vector<GroupParts>& parts);

}  // namespace chladni::report
