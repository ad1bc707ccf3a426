#pragma once

#include "plate/elements/covariant_strains.hpp"

namespace chladni::plate {

/// Shape functions of a triangle whose rotations are enriched by bubbles, which vanish on all
/// edges: 27 r s t for orders 1 and 2, 27 r s t (3 r - 1) and 27 r s t (3 s - 1) for order 3, with
/// t = 1 - r - s. They give the transverse shear inside the element as many rotations as it has
/// conditions; without them thin plates of triangles are too stiff.
/// Source: Brezzi, Fortin and Stenberg, Math. Models Methods Appl. Sci. 1 (1991) 125.
struct BubbleBasis {
  Basis surface;  ///< of the nodes alone
  Basis field;    ///< of the nodes, then of the bubbles
};
/// The shape functions of a triangle with bubbles at some points.
BubbleBasis basis_with_bubbles(int order, const Points& points);

/// The strains in the 6 DOFs of each node, then in 6 DOFs of each bubble, whose translations are to
/// be dropped. A bubble turns the mean director.
CovariantStrains strains_with_bubbles(const BubbleBasis& basis, const ShellNodes& nodes,
                                      StrainParts parts = StrainParts::all);

/// The Schur complement of `K` on the nodes, since no load acts on the bubbles' rotations. A bubble
/// has no stiffness about the mean director; that direction is held.
Eigen::MatrixXd eliminate_bubbles(const Eigen::MatrixXd& K, const ShellNodes& nodes);

/// The motion of nodes and bubbles that follows from the motion of the nodes.
/// @param K  with bubbles, as `eliminate_bubbles` takes it
/// @return [6 (n_nodes + n_bubbles) x 6 n_nodes]
Eigen::MatrixXd motion_with_bubbles(const Eigen::MatrixXd& K, const ShellNodes& nodes);

}  // namespace chladni::plate
