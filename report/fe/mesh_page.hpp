#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/fe/mesh_groups.hpp"
#include "report/output.hpp"

namespace chladni::report {

/// The mesh as a page to turn it, with a list of its groups that shows where each of them is: one
/// file that loads nothing from elsewhere. A large mesh is drawn coarser, which the page then says.
/// @param parts    of the groups
/// @param summary  a table for the end of the page
std::string mesh_page(const std::string& title, const mesh::Mesh& mesh,
                      const std::vector<GroupParts>& parts, const TextTable& summary);

}  // namespace chladni::report
