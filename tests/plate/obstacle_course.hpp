#pragma once

#include "shell_model.hpp"

/// The static cases that shell elements are measured on: each returns its displacement, m.
namespace chladni::plate::testing {

/// Cylindrical roof under its weight: downward deflection of the middle of the free edge. A
/// quarter; MacNeal and Harder, Finite Elem. Anal. Des. 1 (1985) 3.
double scordelis_lo_roof(const Grid& grid);

/// Cylinder between diaphragms, pinched by two forces: deflection under one. An eighth.
double pinched_cylinder(const Grid& grid);

/// Hemisphere with a hole of 18 degrees, pulled and pushed on its equator: displacement of a
/// load. A quarter; MacNeal and Harder.
double hemisphere_with_hole(const Grid& grid);

/// The same without the hole, of three surfaces.
double full_hemisphere(const Grid& grid);

/// Tip displacement of a cantilever strip twisted by 90 degrees, along the force on its tip.
struct TwistedBeam {
  double in_plane;      ///< force along the width of the tip
  double out_of_plane;  ///< force normal to the tip
};
/// @param thickness  0.32 with force 1 (MacNeal and Harder) or 0.0032 with force 1e-6
TwistedBeam twisted_beam(const Grid& grid, double thickness, double force);

/// Raasch's hook: two circular arcs of opposite curvature under a force along their width at the
/// tip. The grid counts both arcs together along u.
double raasch_hook(const Grid& grid);

/// Centre deflection w D / (q L^4) of Morley's rhombic plate of 30 degrees, thickness L / 100,
/// w = 0 alone on the edges.
double morley_rhombus(const Grid& grid);

/// Tip deflection of the hyperbolic paraboloid z = x^2 - y^2, clamped on one edge, under a load of
/// 3.6e8 t^3 per area.
double clamped_hypar(const Grid& grid, double thickness);

/// The annular plate of thickness r_a / 1e4 and bending stiffness 67100 N m, 126 kg/m^2, clamped
/// inside, with fewer than 5000 DOFs.
/// @return its sixth frequency, the first with three nodal diameters, Hz
double thin_annulus(int order);

/// The exact Mindlin value, root of a determinant of Bessel functions. Shear locking would show as
/// a factor.
inline constexpr double thin_annulus_Hz = 1749.730718956;

}  // namespace chladni::plate::testing
