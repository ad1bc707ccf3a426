#pragma once

#include <string>

#include "mesh/exchange/exchange_mesh.hpp"

namespace chladni::mesh {

/// The cells of a .vtu as elements of order 1 to 4, and its groups: an array of whole numbers
/// called `group NAME`, as Chladni's own pictures of meshes have them, is the group NAME of the
/// cells or points where it is not 0; where there are none, each value V of another array NAME of
/// whole numbers is the group `NAME_V`, if the array has no more than 256 values. Vertices are sets
/// of nodes. Lines with the value V are of the group `NAME_V_lines`. Arrays of real numbers are
/// left out with a note.
/// @throws chladni::Error naming line and array, or the cell, of what is wrong or not known.
ExchangeMesh vtu_mesh(const std::string& text);

}  // namespace chladni::mesh
