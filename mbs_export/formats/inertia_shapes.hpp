#pragma once

#include <Eigen/Core>

#include "mbs_export/mass_integrals.hpp"

/// The mass integrals in the terms of the floating frame of reference; a~ b = a x b.
namespace chladni::mbs_export::formats {

/// int x~ phi~_j dm = int phi_j x^T - (x . phi_j) I dm, kg m^2 per unit of q.
Eigen::Matrix3d position_tilde_shape(const MassIntegrals& integrals, Eigen::Index j);

/// int phi~_i phi_j dm = int phi_i x phi_j dm for all i, j: component c, [n x n] skew-symmetric.
Eigen::MatrixXd cross_product(const MassIntegrals& integrals, int c);

/// J = int (x . x) I - x x^T dm about the origin, kg m^2.
Eigen::Matrix3d inertia_about_origin(const MassIntegrals& integrals);

}  // namespace chladni::mbs_export::formats
