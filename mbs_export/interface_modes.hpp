#pragma once

#include <Eigen/Core>

namespace chladni::mbs_export {

/// The responses of the neglected modes to unit loads at attachment DOFs, harmonic with Omega_0:
/// (Lambda_n - Omega_0^2) phi_p = g. They are **IRM** (inertia-relief modes) for Omega_0 = 0 and
/// **FRM** (frequency-response modes) above. A basis with the FRM of a load has the same response
/// to that load at Omega_0 as all modes together.
/// @param omega_n  [n_n] frequencies of the neglected modes, rad/s, ascending
/// @param g        [n_n x n_loads] modal loads: rows of the mode shapes at the loaded DOFs
/// @param Omega_0  rad/s
/// @return [n_n x n_loads] amplitudes of the neglected modes
/// @throws chladni::Error when Omega_0 meets a neglected frequency; the message proposes another.
Eigen::MatrixXd response_modes(const Eigen::VectorXd& omega_n, const Eigen::MatrixXd& g,
                               double Omega_0);

/// Interface modes as independent modes: V^T V = I, V^T diag(omega_n^2) V = diag(omega^2).
struct InterfaceBasis {
  Eigen::MatrixXd V;      ///< [n_n x n_p]
  Eigen::VectorXd omega;  ///< [n_p], rad/s, ascending
  int n_dropped;          ///< number of columns that depend on the others to within 1e-8
};

/// An orthonormal basis of response modes, with rank detection: those of neighbouring nodes are
/// nearly dependent.
InterfaceBasis interface_basis(const Eigen::VectorXd& omega_n, const Eigen::MatrixXd& responses);

}  // namespace chladni::mbs_export
