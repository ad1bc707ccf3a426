#pragma once

#include <string>
#include <vector>

#include "scene/readers.hpp"

/// Readers of the parts of [mesh].

namespace chladni::scene {

/// Whether the scene states the element size or leaves it to `accuracy`.
enum class Size { given, chosen };

/// The options of the generator named by `mesh`; an element size to be chosen later is 0.
mesh::MeshOptions read_generator(const Table& mesh, Size size);

/// The groups that a generator makes besides its rings; empty for a mesh file.
std::vector<std::string> generated_groups(const mesh::MeshOptions& mesh);

/// The number of equal sectors of the body; 1 without the key or when they are to be found.
int read_sectors(const Table& mesh);
/// Whether sectors = "auto".
bool finds_sectors(const Table& mesh);

/// The key `element_order`.
int read_element_order(const Table& mesh);

/// The rings of the mesh.
/// @param taken  names that are not allowed for a ring
/// @param radii  admissible radii, m
std::vector<mesh::RingOptions> read_rings(const Table& mesh, const std::vector<std::string>& taken,
                                          const Admissible& radii);

}  // namespace chladni::scene
