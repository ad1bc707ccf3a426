#pragma once

#include <Eigen/Core>

#include <complex>
#include <vector>

#include "mbs_export/held_modes.hpp"
#include "mbs_export/loaded_dofs.hpp"

namespace chladni::mbs_export {

/// Frequency responses of the complete held body at its loaded DOFs, H(Omega) = B^T ((1 + i eta)
/// diag(omega^2) - Omega^2)^-1 B, at the frequencies where a basis is compared with it. The
/// hysteretic damping eta = 0.02 (1 % of critical damping at a resonance) is used for the
/// comparison only and limits the resonances.
struct ReferenceResponse {
  Eigen::VectorXd omega;  ///< [n] all modes of the held body, rad/s, ascending
  Eigen::MatrixXd B;      ///< [n x m] mode shapes at the loads, in units of each
  Eigen::VectorXd unit;   ///< [m] scales that make forces and moments comparable
  std::vector<ModeCluster> clusters;
  std::vector<int> resonances;      ///< clusters that the loads excite within the range
  Eigen::VectorXd Omega;            ///< [G], rad/s, ascending: resonances and between them
  std::vector<Eigen::MatrixXcd> H;  ///< [G] of [m x m]
  Eigen::MatrixXd size;             ///< [m x G] reference of relative errors of the response
};

/// The modes that a load moves, and rigid ones, or the first mode where there are none. The others,
/// such as modes in the plane of a disc that is loaded along its normal, are zeros in all
/// responses.
/// @return ascending, 0-based
std::vector<int> moved_modes(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B);

/// The modes of a reference alone, which tell its sizes in any band.
/// @param omega  [n] rad/s, all modes of the held body
/// @param B      [n x m] mode shapes at the loads
ReferenceResponse reference_modes(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                  const LoadedDofs& loads);

/// The reference of a body. Its grid has each resonance that contributes more than the tolerance,
/// points 1 % beside it on both sides, three frequencies between neighbours, and the ends of the
/// range.
/// @param omega  [n] rad/s, all modes of the held body
/// @param B      [n x m] mode shapes at the loads
ReferenceResponse reference_response(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                     const LoadedDofs& loads, const Tolerance& tolerance);

/// The sizes that errors of the responses to each load are relative to, |H e_j|, or the root sum of
/// squares of what the modes contribute if it is larger.
struct SizesInBand {
  Eigen::VectorXd at_least;   ///< [m] what they are not below at any frequency of the band
  Eigen::VectorXd in_middle;  ///< [m] at one frequency
};

/// The sizes of `reference_modes` from one frequency to another one. Bounds are the tighter the
/// narrower the band.
/// @param from, to  rad/s, from < to
SizesInBand sizes_in_band(const ReferenceResponse& reference, double from, double to);

/// The diagonal of (1 + i eta) diag(omega^2) - Omega^2.
Eigen::VectorXcd damped_stiffness(const Eigen::VectorXd& omega, double Omega);
/// 1 + i eta.
std::complex<double> stiffness_factor();

/// Interface modes of the loads B p, harmonic with Omega_0, for each column p of `patterns`.
struct InterfaceChoice {
  Eigen::MatrixXd patterns;  ///< [m x k]
  double Omega_0;            ///< rad/s
};

/// A basis of modes and interface modes, and its error against the reference.
struct TrialBasis {
  std::vector<char> is_kept;  ///< [n]
  std::vector<InterfaceChoice> interface;
  Eigen::MatrixXd V;        ///< [n x p] interface modes; zero in the kept modes
  Eigen::VectorXd omega_p;  ///< [p], rad/s
  Eigen::MatrixXd outputs;  ///< B^T V [m x p]; [m x 0]: `with_outputs` gives them
  /// [G] H minus the response of the basis; symmetric, in the lower triangles
  std::vector<Eigen::MatrixXcd> remainder;
  Eigen::MatrixXd error;  ///< [m x G] relative error of the response to each load

  int n_kept() const;
  int n_modes() const { return n_kept() + static_cast<int>(omega_p.size()); }
};

/// The basis of the rigid modes; empty if there are none.
TrialBasis rigid_basis(const ReferenceResponse& reference);

/// The same basis with what all that is tried from it needs.
TrialBasis with_outputs(const ReferenceResponse& reference, TrialBasis basis);

/// The basis with the modes of one more cluster.
TrialBasis with_cluster(const ReferenceResponse& reference, TrialBasis basis,
                        const ModeCluster& cluster);

/// The basis with further interface modes. Those that depend on the basis are not added.
TrialBasis with_interface(const ReferenceResponse& reference, TrialBasis basis,
                          const InterfaceChoice& choice);

/// What a basis would gain, without the basis.
struct Growth {
  int n_modes;            ///< further ones
  Eigen::MatrixXd error;  ///< [m x G] as TrialBasis::error
};

/// With the modes of one more cluster, or with further interface modes.
/// @param basis  `with_outputs`
Growth growth_with(const ReferenceResponse& reference, const TrialBasis& basis,
                   const ModeCluster& cluster);
Growth growth_with(const ReferenceResponse& reference, const TrialBasis& basis,
                   const InterfaceChoice& choice);

/// The undamped response of the modes that are not kept, [n x k].
Eigen::MatrixXd undamped_response(const ReferenceResponse& reference, const TrialBasis& basis,
                                  const InterfaceChoice& choice);

/// The response of all modes to load `j` at grid frequency `g` minus that of the basis, [n].
Eigen::VectorXcd missing_response(const ReferenceResponse& reference, const TrialBasis& basis,
                                  Eigen::Index j, Eigen::Index g);

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
