#pragma once

#include <vector>

#include "mesh/mesh.hpp"
#include "report/json.hpp"
#include "report/output.hpp"

namespace chladni::report {

/// How many nodes, elements of each kind and nodes of each group a mesh has.
TextTable mesh_table(const mesh::Mesh& mesh);

/// Members `n_nodes`, `n_elements`, `mesh_checksum` and `notes`.
std::vector<Json::Member> mesh_json(const mesh::Mesh& mesh);

}  // namespace chladni::report
