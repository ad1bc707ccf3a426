#pragma once

#include <string>

#include "mesh/exchange/exchange_mesh.hpp"

namespace chladni::mesh {

/// Reads the cells of a .vtu as elements of order 1 to 4, and its groups. An array of integers
/// called `group NAME`, as in Chladni's own pictures of meshes, is the group NAME of the cells or
/// points where it is not 0. Without such arrays, each value V of another array NAME of integers is
/// the group `NAME_V`, if the array has at most 256 values; lines with the value V get the group
/// `NAME_V_lines`. Vertices are sets of nodes. Arrays of real numbers are left out with a note.
/// @throws chladni::Error naming line and array, or the cell, that is wrong or unknown.
ExchangeMesh vtu_mesh(const std::string& text);

}  // namespace chladni::mesh
