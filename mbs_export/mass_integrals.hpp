#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>

namespace chladni::mbs_export {

/// Integrals over the mass of a body whose points x (in the frame and about the origin of the mesh)
/// are displaced by u(x) = sum_i phi_i(x) q_i, as a moving frame of reference needs them. They are
/// computed from the FE model, rotary inertia included.
struct MassIntegrals {
  double mass;                            ///< kg
  Eigen::Vector3d first;                  ///< int x dm, kg m
  Eigen::Matrix3d second;                 ///< int x x^T dm, kg m^2
  Eigen::MatrixXd displacement;           ///< [3 x n] row k: int phi_k dm
  Eigen::MatrixXd position_displacement;  ///< [9 x n] row 3 k + l: int x_k phi_l dm
  /// [n x n] S_kl: int phi_k,i phi_l,j dm for kl = xx, yy, zz, xy, yz, zx; S_lk = S_kl^T
  std::array<Eigen::MatrixXd, 6> products;
};

/// The indices k and l of each of MassIntegrals::products.
extern const std::array<std::pair<int, int>, 6> product_axes;

/// S_kl for any k and l, [n x n] kg.
Eigen::MatrixXd displacement_product(const MassIntegrals& integrals, int k, int l);

/// The integrals in other coordinates, with the displacements phi T.
/// @param T  [n x n_new]
MassIntegrals in_coordinates(const MassIntegrals& integrals, const Eigen::MatrixXd& T);

/// G_ij = 2 int phi_i . (e x phi_j) dm, skew-symmetric. A body that spins with Omega about the unit
/// vector e through the origin has the Coriolis forces -Omega G q' in the frame that turns with it.
Eigen::MatrixXd gyroscopic_matrix(const MassIntegrals& integrals, const Eigen::Vector3d& e);

}  // namespace chladni::mbs_export
