#pragma once

#include "mesh/mesh.hpp"

namespace chladni::benchmarks {

/// Annulus of n_r x 4 n_r quadrilaterals of one order, with the geometry of the annulus of the
/// scene; groups "disc" and "inner_edge".
mesh::Mesh polar_grid(double inner_radius, double outer_radius, int order, int n_r);

}  // namespace chladni::benchmarks
