#pragma once

#include <Eigen/Core>

#include <optional>

#include "plate/elements/assumed_strains.hpp"
#include "plate/elements/shell_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// K_e and M_e in the DOFs (u_x, u_y, u_z, theta_x, theta_y, theta_z) of each node in lattice
/// order.
struct ElementMatrices {
  Eigen::MatrixXd K, M;
};

/// K_e and M_e of the degenerated Reissner-Mindlin shell with kappa = 5/6, for quadrilaterals of
/// order 1 to 4 and triangles of order 1 to 3:
/// - order 1 is MITC4+ and MITC3+;
/// - transverse shear and membrane strains assumed (assumed_strains.hpp), bending compatible;
/// - quadrilaterals of order 2 and 3 blend in uniform reduced integration,
///   K = beta K_reduced + (1 - beta) K, beta = min(0.95, t^2 / (t^2 + c h^2)), c = 0.5 and 0.1;
/// - triangles have rotation bubbles (rotation_bubbles.hpp), eliminated in the element; those of
///   order 3 blend compatible shear in, alpha = t^2 / (t^2 + 0.5 h^2);
///   h^2 is a quarter of the sum of the squared edges; both blends vanish in the thin limit;
/// - drilling rotation by Hughes and Brezzi, 1e-3 G t (theta . n - curl u . n / 2)^2, massless;
/// - consistent mass with rotary inertia.
/// @param nodes  D is half the thickness times the unit director
/// @throws chladni::Error for an order that does not exist.
/// Source: Ko, Lee and Bathe, Comput. Struct. 182 (2017) 404 and Lee, Lee and Bathe, Comput.
/// Struct. 138 (2014) 12 (order 1); Bucalem and Bathe, Int. J. Numer. Methods Eng. 36 (1993) 3729
/// (higher order); Hughes and Brezzi, Comput. Methods Appl. Mech. Eng. 72 (1989) 105 (drilling).
ElementMatrices shell_matrices(mesh::Shape shape, int order, const ShellNodes& nodes,
                               const Material& material);

/// Checks that `shell_matrices` has an element of this shape and order.
/// @throws chladni::Error when it has none.
void check_element_exists(mesh::Shape shape, int order);

/// K_e of a triangle before its bubbles (rotation_bubbles.hpp) are eliminated, without drilling
/// stiffness.
/// @return [6 (n_nodes + n_bubbles) squared]
Eigen::MatrixXd triangle_stiffness_with_bubbles(int order, const ShellNodes& nodes,
                                                const Material& material);

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

/// A shell element whose nodes lie in one plane, normal to directors of one length.
struct PlaneShell {
  Eigen::MatrixX2d x;  ///< [n x 2] in the plane, m
  double thickness;    ///< m
  Eigen::Matrix3d Q;   ///< rows: two axes of the plane, then its normal
};

/// The element in its plane; absent for a curved element and for a thickness that is not constant.
std::optional<PlaneShell> in_its_plane(const ShellNodes& nodes);

/// The matrices of `shell_matrices` for a plane quadrilateral of order 2 to 4, with a tenth of the
/// operations. The displacements in the plane (u_1, u_2), the deflection with its rotations (w,
/// phi), phi = theta x n, and the rotation about the normal have separate energies, with strains E
/// of plane displacements:
///   K_u = t sum C[E assumed u],  K_wphi = t^3/12 sum C[E phi] + kappa G t sum |grad w + phi|^2.
/// @param beta  `share_of_reduced_integration`
ElementMatrices plane_matrices(int order, const PlaneShell& shell, const Material& material,
                               double beta);

}  // namespace chladni::plate
