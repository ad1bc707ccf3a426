#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/reference_response.hpp"

namespace chladni::mbs_export {

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
