#pragma once

#include <array>
#include <span>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// One row of elements between two circles about one axis along z.
struct CurvedRow {
  std::array<double, 2> centre;  ///< m
  double inner, outer;           ///< m
};

/// Bends the triangles of order 2 and more in these rows: their nodes become images of a lattice
/// of radius and angle. Straight diagonals of a row that is thinner than the bow of its arcs would
/// cross these.
void bend_triangles(Mesh& mesh, std::span<const CurvedRow> rows);

}  // namespace chladni::mesh
