#pragma once

#include "mesh/mesh.hpp"

namespace chladni::benchmarks {

/// Options of polar_grid.
struct PolarGrid {
  double inner_radius, outer_radius;  ///< m
  int order;                          ///< polynomial order of the elements
  int n_r;                ///< rows of elements along the radius, including the edge rows
  double edge_row = 0.0;  ///< width of one extra row at each edge, m; 0 for none
};

/// An annulus meshed with n_r x 4 n_r quadrilaterals, on the geometry of the scene's generator
/// "annulus", with the groups "disc" and "inner_edge".
mesh::Mesh polar_grid(const PolarGrid& options);

}  // namespace chladni::benchmarks
