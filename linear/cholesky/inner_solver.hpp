#pragma once

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

/// PETSc's solvers inside the reduction: where their options come from, and which of them are
/// suitable.
namespace chladni::linear {

/// A solver for a system with a factor; its type and operators are to be set.
/// @note   Collective.
petsc::LinearSolver new_solver(MPI_Comm comm, const OptionSource& source);

/// Makes an EPS read the options of `source`.
void set_options_source(EPS eps, const OptionSource& source);

/// Creates the factor of a preconditioner whose type, package and operators are set; nothing is
/// factored yet. MUMPS does not print: its errors come back by MatFactorGetError. It solves for 64
/// columns at a time, which is fastest for the hundreds of right-hand sides of a reduction. The
/// options `-<prefix>mat_mumps_icntl_<i>` and `-<prefix>mat_mumps_cntl_<i>` take precedence;
/// PETSc's interface to MUMPS reads them from the global database in any case.
/// @throws chladni::Error when the options chose another preconditioner than a Cholesky factor.
Mat set_up_factor(PC pc, const OptionSource& source);

}  // namespace chladni::linear
