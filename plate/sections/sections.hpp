#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The index into `sections` of each group of the mesh; -1 where there is none.
/// @throws chladni::Error when the group of a section is unknown or has no elements of its kind.
std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const ShellSection> sections);
std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const BeamSection> sections);

}  // namespace chladni::plate
