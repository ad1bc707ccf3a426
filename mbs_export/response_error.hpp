#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/constrained_modes.hpp"
#include "mbs_export/loaded_dofs.hpp"

namespace chladni::mbs_export {

/// Frequency responses of the complete held body at its loaded DOFs,
/// H(Omega) = B^T ((1 + i eta) diag(omega^2) - Omega^2)^-1 B, at the frequencies where a basis is
/// compared with it. The hysteretic damping eta serves the comparison alone: it bounds the
/// resonances, eta = 0.02 being 1 % of the critical damping there.
struct ReferenceResponse {
  Eigen::VectorXd omega;  ///< [n] all modes of the held body, rad/s, ascending
  Eigen::MatrixXd B;      ///< [n x m] mode shapes at the loads, in units of each
  Eigen::VectorXd unit;   ///< [m] that make forces and moments count alike
  std::vector<ModeCluster> clusters;
  std::vector<int> resonances;      ///< clusters that the loads excite within the range
  Eigen::VectorXd Omega;            ///< [G], rad/s, ascending: resonances and between them
  std::vector<Eigen::MatrixXcd> H;  ///< [G] of [m x m]
  Eigen::MatrixXd size;             ///< [m x G] what an error of the response is relative to
};

/// The grid has each resonance that contributes more than the tolerance, 1 % to both sides of it,
/// three frequencies between neighbours, and the ends of the range.
ReferenceResponse reference_response(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                     const LoadedDofs& loads, const Tolerance& tolerance);

/// Interface modes of the loads B p, harmonic with Omega_0, for each column p of `patterns`.
struct InterfaceChoice {
  Eigen::MatrixXd patterns;  ///< [m x k]
  double Omega_0;            ///< rad/s
};

/// A basis of modes and interface modes, and what it leaves of the reference: a value, so that
/// candidates can be tried.
struct TrialBasis {
  std::vector<char> is_kept;  ///< [n]
  std::vector<InterfaceChoice> interface;
  Eigen::MatrixXd V;                        ///< [n x p] interface modes, zero in kept modes
  Eigen::VectorXd omega_p;                  ///< [p], rad/s
  std::vector<Eigen::MatrixXcd> remainder;  ///< [G] H minus the response of the basis
  Eigen::MatrixXd error;                    ///< [m x G] of the response to each load, relative

  int n_kept() const;
  int n_modes() const { return n_kept() + static_cast<int>(omega_p.size()); }
};

/// The basis of the rigid modes, or of nothing.
TrialBasis rigid_basis(const ReferenceResponse& reference);

TrialBasis with_cluster(const ReferenceResponse& reference, const TrialBasis& basis,
                        const ModeCluster& cluster);

/// The same number of modes as before where the interface modes depend on what is there.
TrialBasis with_interface(const ReferenceResponse& reference, const TrialBasis& basis,
                          const InterfaceChoice& choice);

/// [n x k] undamped response of the modes that are not kept.
Eigen::MatrixXd undamped_response(const ReferenceResponse& reference, const TrialBasis& basis,
                                  const InterfaceChoice& choice);

/// [n] response of all modes to load `j` at grid frequency `g`, less that of the basis.
Eigen::VectorXcd missing_response(const ReferenceResponse& reference, const TrialBasis& basis,
                                  Eigen::Index j, Eigen::Index g);

}  // namespace chladni::mbs_export
