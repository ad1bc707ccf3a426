#pragma once

#include <Eigen/Core>
#include <optional>

#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/element_matrices.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

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
