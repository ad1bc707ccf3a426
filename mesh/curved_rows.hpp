#pragma once

#include <array>
#include <span>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// A row of elements between two circles about one axis along z.
struct CurvedRow {
  std::array<double, 2> centre;  ///< m
  double inner, outer;           ///< m
};

/// Bends the triangles of order 2 and higher in these rows: their nodes become images of a lattice
/// in radius and angle. In a row that is thinner than the sagitta of its arcs straight diagonals
/// would cross the arcs.
void bend_triangles(Mesh& mesh, std::span<const CurvedRow> rows);

}  // namespace chladni::mesh
