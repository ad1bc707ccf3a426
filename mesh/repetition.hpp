#pragma once

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// How often a mesh of a whole body repeats about the z axis: the largest N of which a turn by 360
/// degrees / N takes nodes, elements and groups onto nodes, elements and groups; 1 where nothing
/// repeats.
int n_repetitions(const Mesh& mesh);

/// One of the equal sectors of a mesh that repeats so often: of each element and its turned copies
/// the one with the least angle from the x axis on, or from a plane on that makes the sector its
/// own image. The cut follows the sides of elements.
/// @param count  that many at least: `n_repetitions`, or a divisor of it
/// @throws chladni::Error for a mesh that does not repeat so often.
Mesh one_sector(const Mesh& mesh, int count);

}  // namespace chladni::mesh
