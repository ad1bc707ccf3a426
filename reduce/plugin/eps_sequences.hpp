#pragma once

#include <slepceps.h>

#include "reduce/block_iteration.hpp"

/// How the Krylov sequences of a solution begin.
namespace chladni::reduce::plugin {

/// Starts with the vectors that the user gave, if any: those that one block does not hold are added
/// to others, from which the operator separates them.
void start(EPS eps, BlockIteration& iteration, const BlockOperator& op);

/// Keeps the first pairs and begins a new sequence, with room in the basis for some steps, and with
/// wider blocks from the second time on: an eigenvalue of very many copies takes few rounds then.
void begin_anew(EPS eps, BlockIteration& iteration, PetscInt n_kept, const BlockOperator& op);

}  // namespace chladni::reduce::plugin
