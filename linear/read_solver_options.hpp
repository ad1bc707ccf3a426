#pragma once

#include "linear/solver_options.hpp"

namespace chladni::linear {

/// Reads the options of the reduction that do not belong to PETSc's own objects, and lists them for
/// -help. Options that are not given keep the values of `defaults`.
/// @param defaults  its `petsc` also says where the options are read from
/// @note   Collective on `comm`.
/// @throws chladni::Error on all ranks for an invalid value.
/// Options: `-<prefix>memory <MiB>`, `-<prefix>modes_solver block-lanczos|krylov-schur`,
/// `-<prefix>lanczos_block_size`, `-<prefix>lanczos_subspace`, `-<prefix>lanczos_tolerance`
SolverOptions read_solver_options(MPI_Comm comm, const SolverOptions& defaults = {});

}  // namespace chladni::linear
