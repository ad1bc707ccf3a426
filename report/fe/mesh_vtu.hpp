#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/fe/mesh_groups.hpp"

namespace chladni::report {

/// The mesh with its groups as the text of a .vtu file. Its cells are the elements, then the edges
/// of the groups of curves and the nodes of the groups of points. Each cell has the number of its
/// element, 0 for an edge or a node, and the place of its group among those of the mesh, -1 without
/// one; "group NAME" is 1 for the cells of the group NAME. These arrays are left out where they
/// would take more than 30 MB.
/// @param parts  of the groups
std::string mesh_vtu(const mesh::Mesh& mesh, const std::vector<GroupParts>& parts);

}  // namespace chladni::report
