#pragma once

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// The largest N for which a turn by 360 degrees / N about the z axis takes nodes, elements and
/// groups of a whole body to nodes, elements and groups; 1 if there is no such symmetry.
int n_repetitions(const Mesh& mesh);

/// One of the equal sectors of a periodic mesh. Of each element and its turned copies it holds the
/// one with the least angle, measured from the x axis or from a plane that makes the sector its own
/// mirror image. The cut follows the sides of elements.
/// @param count  number of sectors: `n_repetitions` or a divisor of it
/// @throws chladni::Error for a mesh without this symmetry.
Mesh one_sector(const Mesh& mesh, int count);

}  // namespace chladni::mesh
