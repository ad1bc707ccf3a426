#pragma once

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Replaces each quadrilateral with a corner of more than 165 degrees, where its Jacobian (nearly)
/// vanishes, by the two triangles that halve this corner. Recombination leaves such elements where
/// two edges of one triangle lie on a smooth boundary. No node is added, since the lattice of a
/// quadrilateral contains those of both triangles. The triangles keep the number of the
/// quadrilateral.
Mesh split_flat_corners(Mesh mesh);

}  // namespace chladni::mesh
