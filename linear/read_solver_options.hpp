#pragma once

#include "linear/solver_options.hpp"

namespace chladni::linear {

/// Reads all options that the reduction has besides those of PETSc's own objects, and lists them
/// where -help is given. What no option says stays as in `defaults`.
/// @param defaults  also says in `petsc` where the options stand
/// @note   Collective on `comm`.
/// @throws chladni::Error on all ranks for a value that makes no sense.
/// Options: `-<prefix>memory <MiB>`, `-<prefix>modes_solver block-lanczos|krylov-schur`,
/// `-<prefix>lanczos_block_size`, `-<prefix>lanczos_subspace`, `-<prefix>lanczos_tolerance`
SolverOptions read_solver_options(MPI_Comm comm, const SolverOptions& defaults = {});

}  // namespace chladni::linear
