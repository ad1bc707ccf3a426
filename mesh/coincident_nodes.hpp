#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Pairs of nodes nearer than `tolerance` [m], each with the first node of its heap, by index.
std::vector<std::array<int, 2>> coincident_nodes(const Mesh& mesh, double tolerance);

/// Deals with nodes of unconnected elements that stand at one place, within `tolerance` [m];
/// without it a millionth of the extent of the mesh, at most a tenth of the least distance in an
/// element. Merged nodes keep the lower number, and Mesh::notes tells their number.
/// @throws chladni::Error with the numbers of the first pairs when they are to be refused, and with
///         the number of an element that the tolerance would make collapse.
Mesh treat_coincident_nodes(Mesh mesh, Coincident treatment, std::optional<double> tolerance);

}  // namespace chladni::mesh
