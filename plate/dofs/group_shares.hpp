#pragma once

#include <map>
#include <string>

#include "mesh/mesh.hpp"

namespace chladni::plate {

/// int N_i ds of each node, m, over the element edges or lines that have all their nodes in the
/// group. An edge between two elements counts once. Empty if there is no such edge.
std::map<int, double> edge_shares(const mesh::Mesh& mesh, const std::string& group);

/// The share of each node in a group: int N_i dA over the elements of a group of surfaces, m^2, int
/// N_i ds over the edges of a group of curves, m, and 1 if the group has neither.
std::map<int, double> group_shares(const mesh::Mesh& mesh, const std::string& group);

}  // namespace chladni::plate
