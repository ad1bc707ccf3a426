#include "plugin/eps_sequences.hpp"

#include <slepc/private/epsimpl.h>

#include <algorithm>

namespace chladni::plugin {

void start(EPS eps, linear::BlockIteration& iteration, const linear::BlockOperator& op)
{
  const PetscInt n = std::min(eps->nini, iteration.block_size());
  if (n <= 0) return iteration.start(op);
  const petsc::Matrix guesses = iteration.new_block(n);
  petsc::check(MatZeroEntries(guesses));
  for (PetscInt i = 0; i < eps->nini; ++i) {
    Vec v = nullptr, guess = nullptr;
    petsc::check(BVGetColumn(eps->V, i, &v));
    petsc::check(MatDenseGetColumnVec(guesses, i % n, &guess));
    petsc::check(VecAXPY(guess, 1.0, v));
    petsc::check(MatDenseRestoreColumnVec(guesses, i % n, &guess));
    petsc::check(BVRestoreColumn(eps->V, i, &v));
  }
  iteration.start(op, guesses, eps->nini);
}

void begin_anew(EPS eps, linear::BlockIteration& iteration, PetscInt n_kept,
                const linear::BlockOperator& op)
{
  const bool is_second = !iteration.sequence().known.empty();
  const PetscInt b = iteration.block_size();
  const PetscInt widest = std::max(b, eps->nev / 4);
  const PetscInt width = std::min({widest, (is_second ? 2 : 1) * b, eps->n - n_kept});
  petsc::check(PetscInfo(eps,
                         "an eigenvalue may have more copies than the %" PetscInt_FMT
                         " found: %" PetscInt_FMT " new random vectors\n",
                         iteration.sequence().n_sources, width));
  iteration.reserve(std::min(n_kept + 8 * width, eps->n) + width);
  iteration.begin_anew(n_kept, width, op);
}

}  // namespace chladni::plugin
