#include "reduce/quiet_mumps.hpp"

#include <string_view>

#include "common/petsc.hpp"

namespace chladni::reduce {

void quiet_mumps(PC pc)
{
  Mat factor = nullptr;
  MatSolverType package = nullptr;
  petsc::check(PCFactorSetUpMatSolverType(pc));
  petsc::check(PCFactorGetMatrix(pc, &factor));
  petsc::check(MatFactorGetSolverType(factor, &package));
  if (std::string_view(package) != MATSOLVERMUMPS) return;
  constexpr PetscInt nowhere = -1;
  for (const PetscInt stream : {1, 2, 3}) {  // errors, diagnostics, statistics
    petsc::check(MatMumpsSetIcntl(factor, stream, nowhere));
  }
  petsc::check(MatMumpsSetIcntl(factor, 4, 0));  // level
}

}  // namespace chladni::reduce
