#pragma once

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Adds the missing inner nodes of serendipity elements (8-node quadrilaterals and the like), whose
/// lattice holds -1 in their places. Their positions follow from the element's own shape functions:
/// on a quadrilateral by transfinite interpolation of the edges, which is the serendipity space up
/// to order 3, on a cubic triangle at its centre. New nodes get numbers beyond the largest, join
/// the surface groups of their elements, and are mentioned in Mesh::notes.
/// @throws chladni::Error for a triangle of order 4 without inner nodes.
void add_inner_nodes(Mesh& mesh);

}  // namespace chladni::mesh
