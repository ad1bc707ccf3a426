#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <utility>
#include <vector>

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

/// Geometric stiffness by the stress of inertial forces: under a load with the factor f the
/// stiffness of the body is K + f K_sigma. The stress is that of the linear FE model under a
/// support.
struct Stiffening {
  std::vector<std::string> fixed;  ///< the support, as ModalBody::fixed
  std::vector<std::string> loads;  ///< some of `stiffening_loads`, in that order
  std::vector<Eigen::MatrixXd> K;  ///< [n x n] K_sigma, symmetric, for each load
};

/// The names of the loads and the factors they stand for. With the angular velocity omega, the
/// angular acceleration alpha and the acceleration a of the frame (less gravity) in its own axes, a
/// mass dm has the inertial force -(omega x (omega x x) + alpha x x + a) dm:
/// - `omega_xx`, `_yy`, `_zz`, `_xy`, `_yz`, `_zx`: omega_x^2, ..., omega_x omega_y, ...;
/// - `alpha_x`, `_y`, `_z`: alpha_x, ...; `acceleration_x`, `_y`, `_z`: a_x, ...
extern const std::array<std::string, 12> stiffening_loads;

/// The stiffening in other coordinates.
/// @param T  [n x n_new]
Stiffening in_coordinates(const Stiffening& stiffening, const Eigen::MatrixXd& T);

/// K_sigma of a load.
/// @throws chladni::Error when it is missing, naming the loads that exist.
const Eigen::MatrixXd& stiffening_by(const Stiffening& stiffening, const std::string& load);

/// K_sigma of a spin of 1 rad/s about the unit vector e: a spin Omega adds the stiffness Omega^2
/// K_sigma, in addition to the effect of the centrifugal matrix (mass_integrals.hpp).
/// @throws chladni::Error when a load that e needs is missing.
Eigen::MatrixXd spin_stiffening(const Stiffening& stiffening, const Eigen::Vector3d& e);

}  // namespace chladni::mbs_export
