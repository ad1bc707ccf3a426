#pragma once

#include "mesh/mesh.hpp"

namespace chladni::benchmarks {

struct PolarGrid {
  double inner_radius, outer_radius;  ///< m
  int order;
  int n_r;                ///< rows of elements, edge rows among them
  double edge_row = 0.0;  ///< m, width of one row at each edge; 0 without
};

/// Annulus of n_r x 4 n_r quadrilaterals of one order, with the geometry of the annulus of the
/// scene; groups "disc" and "inner_edge".
mesh::Mesh polar_grid(const PolarGrid& options);

}  // namespace chladni::benchmarks
