#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "linear/solver_options.hpp"
#include "reduce/completeness.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/harmonic_response.hpp"
#include "reduce/phases.hpp"
#include "reduce/reduce_options.hpp"
#include "reduce/response_errors.hpp"
#include "reduce/support.hpp"

/// From K and M to the certified reduced model: the functions behind `chladni reduce` and the class
/// CMS.
namespace chladni::reduce {

/// The FE model of a body and its masters.
struct Body {
  petsc::Matrix K, M;  ///< [n x n] symmetric AIJ; owned or references
  /// Global DOFs, each once, in the order of the caller, on all ranks.
  std::vector<PetscInt> masters;
  petsc::Matrix R = {};  ///< [n x r] dense, rigid-body motions by the geometry, or none
  /// Name of a global DOF for messages, as "node 17 (0.1, 0.2, 0), z"; on every rank.
  std::function<std::string(PetscInt)> name_of_dof = {};
  bool may_lack_masters = false;  ///< then a body without masters is reduced to its modes
};

/// The memory that the caller will need after the reduction, beside Psi and Phi.
struct WorkAfterwards {
  double columns = 0.0;                ///< number of vectors as long as a column of Psi
  double columns_for_each_kept = 0.0;  ///< the same for each master and each mode
  /// the same, where the largest part that K and M do not couple with others is worked on by itself
  double of_a_part_for_each_kept = 0.0;
  double matrices = 0.0;  ///< number of matrices as large as M
};

/// How a body is reduced.
struct ReductionOptions {
  ReduceOptions basis = {};
  linear::SolverOptions solver = {};
  /// Whether eigenvalues of the FE model are counted, which turns estimates into bounds. Without a
  /// value they are counted where that takes less than a tenth of the work and the memory suffices.
  std::optional<bool> count = false;
  /// Whether the caller needs K and M afterwards. If not, they are freed as early as possible.
  bool keeps_matrices = true;
  WorkAfterwards later = {};
  /// Kept with the mixed interface only: other methods leave modes of the range out.
  std::optional<ResponseGoal> responses = {};
};

/// A body divided into masters and slaves, with the factor of K_ss: the common start of all
/// methods.
struct FactoredBody {
  petsc::Matrix K, M;             ///< empty after they were freed
  std::vector<PetscInt> masters;  ///< as in Body
  petsc::Matrix R;
  DofPartition dofs;
  Blocks K_blocks, M_blocks;
  linear::Factorization K_ss;
  /// Throws on all ranks when the memory does not suffice for so many fixed-interface modes.
  MemoryCheck require_memory = {};

  MPI_Comm comm() const { return petsc::communicator(K_ss.matrix()); }
};

/// Divides the DOFs into masters and slaves and factors K_ss. K and M are freed at once where these
/// options need them no more; later calls must not ask for more than these did.
/// @note   Collective on the communicator of K, as are all functions of this header.
/// @throws FreeMotion on all ranks when a part of the body can move with all masters held.
/// @throws chladni::Error on all ranks when the masters are no valid partition, or the factor and
///         the basis do not fit into the memory.
FactoredBody factored(Body body, const ReductionOptions& options, PhaseListener& phases);

/// The accuracy of a reduced model under the support that was asked for; the same on every rank.
struct Certificate {
  /// [k] of the certified elastic modes, ascending, rad^2/s^2
  std::vector<double> lambda;
  /// [k] `ErrorEstimates::eta2`; empty where M_r is no projection
  std::vector<double> eta2;
  /// [k] estimated relative errors of the frequencies, by their place in the order
  std::vector<double> estimates;
  /// [k] `ErrorEstimates::rounding`: relative errors of lambda by rounding
  std::vector<double> rounding;
  /// [<= k] upper bounds of the relative errors of lambda, where eigenvalues were counted
  std::vector<double> bounds;
  EigenvalueCount fixed_interface;  ///< up to the last fixed-interface mode
  EigenvalueCount range;            ///< up to the last certified mode
  EigenvalueCount complete;         ///< the largest counted range in which none is missing
  int n_zero = 0;                   ///< number of zero-energy motions without a support
  double zero_energy = 0.0;         ///< their energy over the first elastic lambda; 0 is perfect
  double condition = 0.0;           ///< estimated condition number of K_ss
  double count_share = 0.0;         ///< share of the counts in the work of the reduction, predicted
  ResponseCertificate responses;    ///< for the goal of the options
};

/// The method of a reduction.
struct MethodChoice {
  Method method;
  std::string reason = {};  ///< why `automatic` chose it; else empty
};

/// A reduced model with its basis, its certificate and its method.
struct Reduction {
  CraigBamptonBasis Q_CB;
  ReducedModel model;
  Certificate certificate;
  MethodChoice choice = {.method = Method::craig_bampton};
};

/// Computes the basis, the projection, error estimates, the condition number and the counts. With a
/// given number of modes or a cut-off, modes come before constraint modes to save memory: the
/// subspace of the eigen-solver is as large as the constraint modes.
/// @throws chladni::Error on all ranks when there are fewer modes than asked for, a solver does not
///         converge, or the support does not fit the model.
Reduction reduction(FactoredBody& body, const ReductionOptions& options, const Support& support,
                    PhaseListener& phases);

/// Extends a reduction by responses of the whole free body to harmonic loads, as columns behind the
/// fixed-interface modes (`enrich`). The certificate stays that of the model without them.
/// @throws chladni::Error as `full_responses`.
Reduction with_responses(Reduction reduction, const FactoredBody& body,
                         const std::vector<HarmonicLoads>& loads, PhaseListener& phases);

/// The place in the model, whose masters ascend by DOF, of each coordinate of the caller: the
/// masters in the caller's order, then the modes.
/// @param masters  `Body::masters`
std::vector<int> coordinate_places(const std::vector<PetscInt>& masters, const ReducedModel& model);

}  // namespace chladni::reduce
