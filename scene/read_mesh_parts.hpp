#pragma once

#include <string>
#include <vector>

#include "scene/read_tables.hpp"

/// The parts of [mesh].
namespace chladni::scene {

/// Whether the scene says how large elements are, or an accuracy is to choose it.
enum class Size { given, chosen };

/// The options of the generator that `mesh` names; a size that is chosen later is 0.
mesh::MeshOptions read_generator(const Table& mesh, Size size);

/// The groups that a generator makes besides its rings; empty for a file.
std::vector<std::string> generated_groups(const mesh::MeshOptions& mesh);

/// Equal sectors of the body, 1 without the key or where they are to be found.
int read_sectors(const Table& mesh);
/// sectors = "auto"
bool finds_sectors(const Table& mesh);

int read_element_order(const Table& mesh);

/// @param taken  names that no ring may have
std::vector<mesh::RingOptions> read_rings(const Table& mesh, const std::vector<std::string>& taken,
                                          const Admissible& radii);

}  // namespace chladni::scene
