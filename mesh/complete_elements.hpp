#pragma once

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Gives serendipity elements (8-node quadrilaterals and the like), whose inner lattice places hold
/// -1, the nodes that they lack, each where the element's own shape functions put it: on a
/// quadrilateral by transfinite interpolation of the edges, which is the serendipity space up to
/// order 3, on a cubic triangle at its centre. New nodes get numbers beyond the greatest, join the
/// groups of surfaces of their elements, and are told in Mesh::notes.
/// @throws chladni::Error for a triangle of order 4 without inner nodes.
void add_inner_nodes(Mesh& mesh);

}  // namespace chladni::mesh
