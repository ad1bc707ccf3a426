#pragma once

#include "common/petsc.hpp"

namespace chladni::reduce {

/// PETSc's name of our Cholesky factorisation: `-pc_factor_mat_solver_type mumps-metis`.
inline constexpr const char* mumps_metis = "mumps-metis";

/// Registers it with PETSc for AIJ matrices, once in a process. The options
/// `-<prefix>mat_mumps_icntl_<i>` and `-<prefix>mat_mumps_cntl_<i>` are those of PETSc's own
/// interface to MUMPS, MatMumpsGetInfog works on the factor, and MatSolve, MatMatSolve and
/// MatMatTransposeSolve (sparse right-hand sides) take matrices distributed by rows as they are.
/// @throws chladni::Error when PETSc does.
void register_mumps_metis();

/// What the factor may take of one machine's memory: a symbolic factorisation that needs more ends
/// with MAT_FACTOR_OUTMEMORY. Without effect on factors of other types.
void set_budget(Mat F, double MiB);

/// What the numerical factorisation needs on the fullest machine, by the symbolic one; 0 for other
/// types.
/// @note   Collective.
double forecast_MiB(Mat F);

}  // namespace chladni::reduce
