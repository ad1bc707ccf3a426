#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace chladni::mbs_export {

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
