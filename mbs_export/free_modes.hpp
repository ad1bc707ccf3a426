#pragma once

#include <Eigen/Core>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Free modes of the reduced system: Q_e^T M_r Q_e = I, Q_e^T K_r Q_e = diag(omega^2).
struct FreeModes {
  Eigen::VectorXd omega;  ///< [n_modes], rad/s, ascending; the first n_rigid are exactly zero
  Eigen::MatrixXd Q_e;    ///< [n_FE x n_modes]
  int n_rigid;            ///< 6 in space, 2 for a bending beam, 0 for a grounded structure
  int n_massless;         ///< number of reduced coordinates without mass: n_FE - n_modes
  double
      rigid_residual;  ///< largest phi_r^T K_r phi_r over the first elastic omega^2; 0 is perfect
};

/// The rigid-body motions that K_r does not resist.
struct RigidModes {
  Eigen::MatrixXd R;      ///< [n_FE x n_rigid], M_r-orthonormal
  double largest_energy;  ///< largest phi_r^T K_r phi_r, rad^2/s^2
};

/// The rigid-body vectors of the geometry that K_r does not resist.
/// @throws chladni::Error when M_r gives one of the rigid-body motions no mass.
RigidModes rigid_modes(const ReducedSystem& reduced);

/// Solves (K_r - omega^2 M_r) phi = 0. Rigid modes are not found as small frequencies: they are the
/// rigid-body vectors of the geometry that K_r does not resist, and are deflated. K_r and M_r must
/// be symmetric positive semidefinite, without other zero-energy motions than rigid ones.
/// @throws chladni::Error when K_r is singular beyond the rigid-body motions, or M_r gives one of
///         these no mass.
FreeModes orthogonalize(const ReducedSystem& reduced);

/// Rigid-body motions of the reduced coordinates, from geometry alone: translations along x, y, z
/// and rotations about axes through `point`, u = e x (X - point), theta = e. The fixed-interface
/// amplitudes are zero, since constraint modes carry a rigid motion of the masters to all nodes.
/// @param point  m
/// @return [n_FE x 6]; zero columns for motions that no master takes part in
Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_body_vectors(const ReducedSystem& reduced,
                                                            const Eigen::Vector3d& point);

/// Mean position of the attachment nodes, m.
Eigen::Vector3d centre_of_nodes(const ReducedSystem& reduced);

/// The inertia of the body as a rigid one.
struct RigidInertia {
  double mass;                     ///< kg
  Eigen::Vector3d centre_of_mass;  ///< m
  Eigen::Matrix3d inertia;         ///< about the centre of mass, kg m^2
};

/// The inertia from R^T M_r R of the rigid-body vectors R, exact for the consistent mass of the
/// full model. If the masters lack components (a bending beam), what depends on them is zero; the
/// mass is that of the translations that exist.
RigidInertia rigid_inertia(const ReducedSystem& reduced);

}  // namespace chladni::mbs_export
