#pragma once

#include <Eigen/Core>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

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
