#pragma once

#include "plate/elements/shell_strains.hpp"
#include "plate/plate_options.hpp"

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

/// Interpolation of assumed strains from tying points, with a set of points and a matrix of weights
/// for each component.
struct Tying {
  struct Component {
    Basis basis;              ///< at the tying points
    Eigen::MatrixXd weights;  ///< [n_integration_points x n_tying_points]
  };
  std::array<Component, 2> shear;  ///< gamma_1, gamma_2
  /// eps_11, eps_22, eps_12; unused at order 1
  std::array<Component, 3> membrane;
};

/// Tying points of the quadrilateral of order p. Shear: gamma_xi at Gauss_p in xi times
/// Gauss-Lobatto p+1 in eta (on the element edges), gamma_eta transposed. Membrane: eps_xixi at
/// Gauss_p x Gauss_(p+1), eps_etaeta transposed, eps_xieta at Gauss_p x Gauss_p. Each order is
/// computed once.
const Tying& quadrilateral_tying(int order);

/// Replaces the transverse shear and membrane rows of the compatible strains by assumed ones;
/// bending stays compatible. The membrane strains are corrected by a field that is constant in a
/// local Cartesian frame, so that their element mean is that of the compatible ones; otherwise
/// distorted elements fail the constant-stress patch test. Order 1 has the membrane strains of
/// MITC4+ instead.
/// @param frame  of the surface at the integration points
CovariantStrains assume_quadrilateral_strains(int order, const Points& integration,
                                              const ShellNodes& nodes, const ShellFrame& frame,
                                              const CovariantStrains& compatible);

/// Membrane strains of MITC4+ from eps_11 and eps_22 at the middles of the edges and eps_12 at the
/// centre. Their combination vanishes for every inextensional bending of a warped element, where
/// compatible strains lock, and passes the patch test.
/// Source: Ko, Lee and Bathe, Comput. Struct. 182 (2017) 404.
std::array<StrainRows, 3> assume_bilinear_membrane(const Points& integration,
                                                   const ShellNodes& nodes);

/// Strains of the triangle of order 1, MITC3+, at any points: rotations enriched by a bubble
/// (rotation_bubbles.hpp), shear tied at six inner points, constant membrane strains.
/// @param basis  at `points`
/// Source: Lee, Lee and Bathe, Comput. Struct. 138 (2014) 12.
CovariantStrains linear_triangle_strains(const ShellNodes& nodes, const BubbleBasis& basis,
                                         const Points& points);

/// Transverse shear strains of a triangle of order 2 or 3 at its (p+1)^2 Gauss points, tied in the
/// Nedelec space of the first kind: the tangential component at p Gauss points of each edge, both
/// components at inner points.
CovariantStrains assume_triangle_shear(int order, const ShellNodes& nodes,
                                       const CovariantStrains& compatible);

/// Membrane strains of a triangle of order 2 or 3 at its (p+1)^2 Gauss points, interpolated in the
/// Regge space of degree p-1: the strain along each edge at its p Gauss points, and the moments of
/// all components against the polynomials of degree p-2, which keep the element mean.
/// @param compatible  strains with the bubbles of rotation_bubbles.hpp, at the Gauss points
/// Source: Neunteufel and Schoeberl, Comput. Methods Appl. Mech. Eng. 373 (2021) 113524.
CovariantStrains assume_triangle_membrane(int order, const ShellNodes& nodes,
                                          const CovariantStrains& compatible);

/// Adds to `tied` the constant Cartesian membrane strain that restores the element mean of
/// `compatible`. The mean weights each point with `weight` times the area element.
std::array<StrainRows, 3> correct_mean(const std::array<StrainRows, 3>& tied,
                                       const std::array<StrainRows, 3>& compatible,
                                       const ShellFrame& frame, const Eigen::VectorXd& weight);

}  // namespace chladni::plate
