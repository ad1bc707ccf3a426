#pragma once

#include <Eigen/Core>

#include "mbs_export/body_options.hpp"
#include "mbs_export/inertia.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::formats {

/// A modal body that moves with a frame: rigid motion is that of the frame, deformation is by the
/// elastic modes. The coupling of both is exact for the consistent mass of the full model.
struct FloatingBody {
  ModalBody body;  ///< elastic modes only, without rings and resultants
  Eigen::Matrix<double, 3, Eigen::Dynamic> momentum;          ///< int u_j dm of each mode
  Eigen::Matrix<double, 3, Eigen::Dynamic> angular_momentum;  ///< int X x u_j dm about the origin
};

/// The elastic modes of `make_body`, in the frame of the mesh. Modes of a body that is not held are
/// orthogonal to the rigid motions and carry no momentum; those of a held body do.
/// @throws chladni::Error as `make_body`.
/// @throws ExportError when springs or dampers to the ground resist a rigid motion (K R != 0, or C
///         R != 0 if the body has the dampers), which they could not do to the frame, and when the
///         masters do not show all six rigid motions.
FloatingBody floating_body(const ReducedSystem& reduced, const BodyOptions& options);

/// The largest momentum of a mode over that of the body at the same kinetic energy; below 1e-6 it
/// is round-off.
double coupling(const FloatingBody& floating);

}  // namespace chladni::mbs_export::formats

/// The mass integrals in the terms of the floating frame of reference; a~ b = a x b.

namespace chladni::mbs_export::formats {

/// int x~ phi~_j dm = int phi_j x^T - (x . phi_j) I dm, kg m^2 per unit of q.
Eigen::Matrix3d position_tilde_shape(const MassIntegrals& integrals, Eigen::Index j);

/// int phi~_i phi_j dm = int phi_i x phi_j dm for all i, j: component c, [n x n] skew-symmetric.
Eigen::MatrixXd cross_product(const MassIntegrals& integrals, int c);

/// J = int (x . x) I - x x^T dm about the origin, kg m^2.
Eigen::Matrix3d inertia_about_origin(const MassIntegrals& integrals);

}  // namespace chladni::mbs_export::formats
