#pragma once

#include "linear/cholesky/cholesky_factor.hpp"

namespace chladni::linear {

/// PETSc's names of our Cholesky factorisations, `-pc_factor_mat_solver_type <name>`: our own one
/// for plates and shells with many right-hand sides, and MUMPS with METIS' ordering.
inline constexpr const char* supernodal = "supernodal";
inline constexpr const char* mumps_metis = "mumps-metis";

/// Registers both with PETSc for AIJ matrices, once between its initialisation and its end. An
/// indefinite matrix is passed to MUMPS with pivoting, by supernodal as well. MatSolve, MatMatSolve
/// and MatMatTransposeSolve (sparse right-hand sides) take matrices distributed by rows as they
/// are. For mumps-metis the options `-<prefix>mat_mumps_icntl_<i>` and
/// `-<prefix>mat_mumps_cntl_<i>` are those of PETSc's own interface to MUMPS, and MatMumpsGetInfog
/// works on the factor.
/// @throws chladni::Error when PETSc fails.
void register_cholesky_types();

/// True if a factor is of one of these types. The functions below have no effect on others.
bool is_ours(Mat F);

/// Sets the memory for a factor. A symbolic factorisation that needs more on any machine ends with
/// MAT_FACTOR_OUTMEMORY.
void set_budget(Mat F, const MemoryBudget& budget);

/// Replaces the memory that the budget of a factor holds for other things.
void set_beside(Mat F, double beside_MiB, const SecondFactor& second);

/// Makes an indefinite matrix an error: its factorisation ends with MAT_FACTOR_NUMERIC_ZEROPIVOT
/// and the number of its negative pivots.
void require_definite(Mat F);

/// The number of negative pivots.
PetscInt our_negative_pivots(Mat F);

/// The size of a factor; zero for other types.
FactorSize factor_size(Mat F);

/// The need of the machine with the least reserve, during the factorisation and after it with what
/// comes beside the factor, by the symbolic factorisation. Zero for other types.
/// @note   Collective.
MemoryNeed memory_need(Mat F);

}  // namespace chladni::linear
