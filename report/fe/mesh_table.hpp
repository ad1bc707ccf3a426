#pragma once

#include <vector>

#include "mesh/mesh.hpp"
#include "report/json.hpp"
#include "report/output.hpp"

namespace chladni::report {

/// A table with the numbers of nodes, of elements of each kind and of nodes in each group.
TextTable mesh_table(const mesh::Mesh& mesh);

/// JSON members `n_nodes`, `n_elements`, `mesh_checksum` and `notes`.
std::vector<Json::Member> mesh_json(const mesh::Mesh& mesh);

}  // namespace chladni::report
