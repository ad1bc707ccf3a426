#pragma once

#include "linear/cholesky/cholesky_factor.hpp"

namespace chladni::linear {

/// PETSc's names of our Cholesky factorisations, `-pc_factor_mat_solver_type <name>`: one of our
/// own for plates and shells with many right-hand sides, and MUMPS with METIS' ordering.
inline constexpr const char* supernodal = "supernodal";
inline constexpr const char* mumps_metis = "mumps-metis";

/// Registers them with PETSc for AIJ matrices, once between its initialisation and its end. An
/// indefinite matrix goes over to MUMPS with pivoting by itself, also from supernodal. MatSolve,
/// MatMatSolve and MatMatTransposeSolve (sparse right-hand sides) take matrices distributed by rows
/// as they are. For mumps-metis the options `-<prefix>mat_mumps_icntl_<i>` and
/// `-<prefix>mat_mumps_cntl_<i>` are those of PETSc's own interface to MUMPS, and MatMumpsGetInfog
/// works on the factor.
/// @throws chladni::Error when PETSc does.
void register_cholesky_types();

/// Whether a factor is of one of these types; only then do the following have an effect.
bool is_ours(Mat F);

/// A symbolic factorisation that needs more on any machine ends with MAT_FACTOR_OUTMEMORY.
void set_budget(Mat F, const MemoryBudget& budget);

/// Other things come beside the factor than its budget said.
void set_beside(Mat F, double beside_MiB, const SecondFactor& second);

/// An indefinite matrix ends with MAT_FACTOR_NUMERIC_ZEROPIVOT and the count of its negative
/// pivots.
void require_definite(Mat F);

PetscInt our_negative_pivots(Mat F);

/// Zero for other types.
FactorSize factor_size(Mat F);

/// The tightest machine during the factorisation and after it, with what comes beside it, by the
/// symbolic factorisation; nothing for other types.
/// @note   Collective.
MemoryNeed memory_need(Mat F);

}  // namespace chladni::linear
