#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// The elements of a block that have the same nodes as one before them: the first one and the
/// other, ascending by the other.
std::vector<std::array<int, 2>> doubled_elements(const ElementBlock& block);

/// Makes elements of one type with the same nodes one element, since some formats write an element
/// once for each of its groups. It is of the group that has a section (`shell_groups`,
/// `line_groups`), else of that of the first one. A note tells how many there were.
/// @throws chladni::Error naming two groups of an element that have a section each.
void merge_doubled_elements(Mesh& mesh, const MeshOptions& options);

}  // namespace chladni::mesh
