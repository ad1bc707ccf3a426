#pragma once

#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/rotation_bubbles.hpp"

namespace chladni::plate {

/// Integration points with their bases.
struct Rule {
  Points points;
  Basis basis;
};

/// The integration rules of an element.
struct Rules {
  Rule full, reduced;   ///< Gauss p+1 and Gauss p
  BubbleBasis bubbles;  ///< for triangles of order 2 and 3, at the points of `full`
};

/// The rules of an element type, computed once.
const Rules& rules_of(mesh::Shape shape, int order);

/// alpha of the drilling stiffness alpha G t (theta . n - curl u . n / 2)^2. It is small, because a
/// clamp holds this rotation where the curl is free.
constexpr double drilling_factor = 1e-3;

/// t^2 / (t^2 + c h^2): 1 for thick elements, 0 for thin ones. h^2 is a quarter of the sum of the
/// squared straight edges, the squared side of a square.
double thickness_blend(mesh::Shape shape, int order, const ShellNodes& nodes, double c);

/// beta of K = beta K_reduced + (1 - beta) K, with K_reduced of the compatible strains at Gauss p.
/// It softens thick quadrilaterals of order 2 and 3; in thin ones K_reduced would lock.
double share_of_reduced_integration(int order, const ShellNodes& nodes);

}  // namespace chladni::plate
