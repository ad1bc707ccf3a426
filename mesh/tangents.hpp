#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Derivatives of the shape functions of an element at its own nodes.
struct NodeDerivatives {
  int n_nodes;
  std::vector<double> first, second;  ///< [n_nodes x n_nodes], d N_j / d xi or eta at node i
};

/// The derivatives of the complete Lagrange basis on the equidistant lattice of a triangle or
/// quadrilateral. Parent coordinates are in [0, 1].
NodeDerivatives node_derivatives(Shape shape, int order);

}  // namespace chladni::mesh
