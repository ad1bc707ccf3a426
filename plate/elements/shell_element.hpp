#pragma once

#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/element_matrices.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

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

}  // namespace chladni::plate
