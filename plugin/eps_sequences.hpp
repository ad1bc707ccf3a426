#pragma once

#include <slepceps.h>

#include "linear/lanczos/block_iteration.hpp"

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
