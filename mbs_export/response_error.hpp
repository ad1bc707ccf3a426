#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/constrained_modes.hpp"
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

/// The reference of a body. Its grid has each resonance that contributes more than the tolerance,
/// points 1 % beside it on both sides, three frequencies between neighbours, and the ends of the
/// range.
/// @param omega  [n] rad/s, all modes of the held body
/// @param B      [n x m] mode shapes at the loads
ReferenceResponse reference_response(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                     const LoadedDofs& loads, const Tolerance& tolerance);

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

}  // namespace chladni::mbs_export
