#pragma once

#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/rotation_bubbles.hpp"

namespace chladni::plate {

/// Integration points with their bases.
struct Rule {
  Points points;
  Basis basis;
};

struct Rules {
  Rule full, reduced;   ///< Gauss p+1 and p
  BubbleBasis bubbles;  ///< of triangles of order 2 and 3, at the points of `full`
};

/// Made once for each element of the library.
const Rules& rules_of(mesh::Shape shape, int order);

/// alpha of alpha G t (theta . n - curl u . n / 2)^2, which gives the rotation about the normal its
/// stiffness: small, because a clamp holds this rotation where the curl is free.
constexpr double drilling_factor = 1e-3;

/// t^2 / (t^2 + c h^2) with h^2 a quarter of the sum of the squared straight edges, the h^2 of a
/// square: 1 for thick elements, 0 for thin ones.
double thickness_blend(mesh::Shape shape, int order, const ShellNodes& nodes, double c);

/// beta of K = beta K_reduced + (1 - beta) K, with K_reduced of the compatible strains at Gauss p:
/// it softens thick quadrilaterals of order 2 and 3 and would lock in thin ones.
double share_of_reduced_integration(int order, const ShellNodes& nodes);

}  // namespace chladni::plate
