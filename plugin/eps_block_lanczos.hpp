#pragma once

#include <slepceps.h>

#include <span>
#include <vector>

#include "common/petsc.hpp"
#include "linear/lanczos/block_iteration.hpp"

/// How well pairs satisfy A x = lambda B x, by multiplication with A and B.

namespace chladni::plugin {

/// An eigenvalue, and its distance to what the transformation inverts about.
struct Eigenvalue {
  double lambda, distance;
};

/// The eigenvalue of a value theta of the transformed problem.
Eigenvalue eigenvalue(EPS eps, double theta);

/// Residuals of one pair.
struct PairErrors {
  /// ||A x - lambda B x|| over (lambda - sigma) B x, in a norm that does not depend on units; 0
  /// where it is round-off of A x.
  double scaled;
  double printed;    ///< ||A x - lambda B x|| / |lambda| ||x||, as EPSErrorView prints it
  double round_off;  ///< of `printed`, at least
};

/// @param X  dense, a column for each value
/// @note   Collective.
std::vector<PairErrors> pair_errors(EPS eps, Mat X, std::span<const Eigenvalue> values);

/// Pairs of A x = lambda B x in the wanted order.
struct Pairs {
  std::vector<double> lambda;
  petsc::Matrix X;  ///< orthonormal in B
};

/// The pairs of the space that Op X spans, by Rayleigh and Ritz with A and B themselves: what an
/// inexact operator has left of the residuals becomes less where it inverts.
/// @note   Collective.
Pairs refined(EPS eps, Mat X, const linear::BlockOperator& op);

}  // namespace chladni::plugin

/// The starting blocks of the Krylov sequences of an EPS.

namespace chladni::plugin {

/// Starts the first sequence, with the vectors of EPSSetInitialSpace if there are any. If these are
/// more than a block holds, several are added up in one column; the operator separates them.
void start(EPS eps, linear::BlockIteration& iteration, const linear::BlockOperator& op);

/// Keeps the first n_kept pairs and begins a new sequence of random vectors, with room in the basis
/// for some steps. From the second time on blocks are twice as wide, so that an eigenvalue of very
/// high multiplicity needs few rounds.
void begin_anew(EPS eps, linear::BlockIteration& iteration, PetscInt n_kept,
                const linear::BlockOperator& op);

}  // namespace chladni::plugin

/// What the solver type "blocklanczos" does not do, and why: one table for EPSSetUp, for -help and
/// for docs/how-to/plugin.md.
namespace chladni::plugin {

struct Refusal {
  const char* what;    ///< as a user asks for it
  const char* reason;  ///< and what to do instead
  bool (*is_asked)(EPS eps);
};

std::span<const Refusal> refusals();

/// @throws chladni::Error for the first row that the EPS asks for. Call it from EPSSetUp.
void refuse_what_is_not_there(EPS eps);

}  // namespace chladni::plugin
