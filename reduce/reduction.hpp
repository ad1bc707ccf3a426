#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "linear/solver_options.hpp"
#include "reduce/completeness.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/full_responses.hpp"
#include "reduce/phases.hpp"
#include "reduce/reduce_options.hpp"
#include "reduce/response_errors.hpp"
#include "reduce/support.hpp"

/// From K and M to the certified reduced model: what `chladni reduce` and the class CMS run.
namespace chladni::reduce {

/// A body and what is kept of it.
struct Body {
  petsc::Matrix K, M;             ///< [n x n] symmetric AIJ; owned or references
  std::vector<PetscInt> masters;  ///< global DOFs, each once, in the order of the caller, on all
                                  ///< ranks
  petsc::Matrix R = {};           ///< [n x r] dense, rigid-body motions of the geometry, or none
  /// "node 17 (0.1, 0.2, 0), z" of a global DOF, for messages; on every rank
  std::function<std::string(PetscInt)> name_of_dof = {};
  bool may_lack_masters = false;  ///< its modes alone are a reduced model
};

/// The memory in which the caller works afterwards, beside Psi and Phi.
struct WorkAfterwards {
  double columns = 0.0;                ///< of the length of Psi
  double columns_for_each_kept = 0.0;  ///< master or mode
  double matrices = 0.0;               ///< as large as M
};

/// How a body is reduced.
struct ReductionOptions {
  ReduceOptions basis = {};
  linear::SolverOptions solver = {};
  /// Whether eigenvalues of the FE model are counted, which makes bounds of estimates; nothing:
  /// where that is less than a tenth of the work and there is memory for it.
  std::optional<bool> count = false;
  /// Whether K and M are wanted afterwards; else they are given back as soon as may be.
  bool keeps_matrices = true;
  WorkAfterwards later = {};
  /// Kept by the mixed interface alone: other methods leave modes of the range out.
  std::optional<ResponseGoal> responses = {};
};

/// Masters and slaves parted, and the factor of K_ss: what all methods share.
struct FactoredBody {
  petsc::Matrix K, M;             ///< empty where they were given back
  std::vector<PetscInt> masters;  ///< as in Body
  petsc::Matrix R;
  DofPartition dofs;
  Blocks K_blocks, M_blocks;
  linear::Factorization K_ss;
  /// Throws on all ranks where the memory does not suffice for so many fixed-interface modes.
  MemoryCheck require_memory = {};

  MPI_Comm comm() const { return petsc::communicator(K_ss.matrix()); }
};

/// @note   Collective on the communicator of K, as all of this header.
/// @throws FreeMotion on all ranks when a part of the body can move with all masters held.
/// @throws chladni::Error on all ranks when the masters cannot be parted from the rest, or factor
///         and basis do not fit into the memory.
FactoredBody factored(Body body, const ReductionOptions& options, PhaseListener& phases);

/// How good a reduced model is under the support that was asked for; the same on every rank.
struct Certificate {
  std::vector<double> lambda;       ///< [k] of the certified elastic modes, ascending; rad^2/s^2
  std::vector<double> eta2;         ///< [k] `ErrorEstimates`; empty where M_r is no projection
  std::vector<double> estimates;    ///< [k] of the relative errors of the frequencies, by place
  std::vector<double> rounding;     ///< [k] of lambda, relative
  std::vector<double> bounds;       ///< [<= k] of the errors of lambda that are counted
  EigenvalueCount fixed_interface;  ///< up to the last fixed-interface mode
  EigenvalueCount range;            ///< up to the last certified mode
  EigenvalueCount complete;         ///< the largest range looked at in which none is missing
  int n_zero = 0;                   ///< zero-energy motions without any support
  double zero_energy = 0.0;         ///< theirs over the first elastic lambda; 0 is perfect
  double condition = 0.0;           ///< estimate for K_ss
  double count_share = 0.0;         ///< of a count in the reduction's work
  ResponseCertificate responses;    ///< of the goal of the options
};

/// The method of a reduction.
struct MethodChoice {
  Method method;
  std::string reason = {};  ///< why that one, where it was chosen automatically
};

/// A reduced model, its basis and its certificate.
struct Reduction {
  CraigBamptonBasis Q_CB;
  ReducedModel model;
  Certificate certificate;
  MethodChoice choice = {.method = Method::craig_bampton};
};

/// Basis, projection, error estimates, condition and count. Memory: modes come before constraint
/// modes, since the subspace of the eigen-solver is as large as these.
/// @throws chladni::Error on all ranks when there are not as many modes, a solver does not
///         converge, or the support does not fit the model.
Reduction reduction(FactoredBody& body, const ReductionOptions& options, const Support& support,
                    PhaseListener& phases);

/// The same with room for the responses of the whole free body to harmonic loads: columns behind
/// the fixed-interface modes (`enrich`). The certificate stays that of the model without.
/// @throws chladni::Error as full_responses
Reduction with_responses(Reduction reduction, const FactoredBody& body,
                         const std::vector<HarmonicLoads>& loads, PhaseListener& phases);

/// For each coordinate of the caller (masters in his order, then modes) its place in the model,
/// whose masters ascend by DOF.
/// @param masters  as in Body
std::vector<int> coordinate_places(const std::vector<PetscInt>& masters, const ReducedModel& model);

}  // namespace chladni::reduce
