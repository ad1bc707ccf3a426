#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/fe/mesh_groups.hpp"
#include "report/output.hpp"

namespace chladni::report {

/// The mesh as an HTML page in which it can be turned, with a list of the groups that shows where
/// each is. The page is one file and loads nothing else. A large mesh is drawn coarser, and the
/// page says so.
/// @param parts    of the groups of the mesh, from group_parts
/// @param summary  table for the end of the page
std::string mesh_page(const std::string& title, const mesh::Mesh& mesh,
                      const std::vector<GroupParts>& parts, const TextTable& summary);

}  // namespace chladni::report
