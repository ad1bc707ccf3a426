#pragma once

#include <slepceps.h>

#include "linear/lanczos/block_iteration.hpp"

/// How the Krylov sequences of a solution begin.
namespace chladni::plugin {

/// Starts with the vectors that the user gave, if any: those that one block does not hold are added
/// to others, from which the operator separates them.
void start(EPS eps, linear::BlockIteration& iteration, const linear::BlockOperator& op);

/// Keeps the first pairs and begins a new sequence, with room in the basis for some steps, and with
/// wider blocks from the second time on: an eigenvalue of very many copies takes few rounds then.
void begin_anew(EPS eps, linear::BlockIteration& iteration, PetscInt n_kept,
                const linear::BlockOperator& op);

}  // namespace chladni::plugin
