#pragma once

#include <map>
#include <string>

#include "mesh/mesh.hpp"

namespace chladni::plate {

/// int N_i ds of each node over the element edges, or lines, that have all their nodes in the
/// group; m. An edge between two elements counts once. Empty where there is no such edge.
std::map<int, double> edge_shares(const mesh::Mesh& mesh, const std::string& group);

/// The part that each node of a group stands for: int N_i dA over the elements of a group of
/// surfaces, int N_i ds over the edges of a group of curves, 1 where the group has neither.
std::map<int, double> group_shares(const mesh::Mesh& mesh, const std::string& group);

}  // namespace chladni::plate
