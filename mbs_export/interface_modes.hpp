#pragma once

#include <Eigen/Core>

namespace chladni::mbs_export {

/// What the neglected modes answer to unit loads at attachment DOFs, harmonic with Omega_0:
/// (Lambda_n - Omega_0^2) phi_p = g. **IRM** (inertia-relief mode) at Omega_0 = 0, **FRM**
/// (frequency-response mode) above. A basis that contains the FRM of a load answers to that load at
/// Omega_0 exactly as all modes together do.
/// @param omega_n  [n_n] frequencies of the neglected modes, rad/s, ascending
/// @param g        [n_n x n_loads] modal loads: rows of the mode shapes at the loaded DOFs
/// @param Omega_0  rad/s
/// @return [n_n x n_loads] amplitudes of the neglected modes
/// @throws chladni::Error when Omega_0 meets a neglected frequency; it proposes another.
Eigen::MatrixXd response_modes(const Eigen::VectorXd& omega_n, const Eigen::MatrixXd& g,
                               double Omega_0);

/// Interface modes as independent modes of their own: V^T V = I, V^T diag(omega_n^2) V =
/// diag(omega^2).
struct InterfaceBasis {
  Eigen::MatrixXd V;      ///< [n_n x n_p]
  Eigen::VectorXd omega;  ///< [n_p], rad/s, ascending
  int n_dropped;          ///< columns that depend on the others to within 1e-8
};

/// Response modes of neighbouring nodes are nearly dependent: orthonormal basis with rank
/// detection.
InterfaceBasis interface_basis(const Eigen::VectorXd& omega_n, const Eigen::MatrixXd& responses);

}  // namespace chladni::mbs_export
