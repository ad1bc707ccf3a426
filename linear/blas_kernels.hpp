#pragma once

namespace chladni::linear {

/// Restarts this program with OPENBLAS_CORETYPE set to kernels that the processor supports, if
/// OpenBLAS has chosen its slowest ones (SSE3). OpenBLAS 0.3.21 does so on processors newer than
/// itself, which slows a reduction by a third. Otherwise, or if the variable is already set,
/// returns.
/// @note   To be called first in main, before MPI starts.
void restart_with_fitting_blas_kernels(char** argv);

/// Divides the processors of this machine among its ranks, unless the environment sets a number of
/// threads. OpenBLAS would start as many threads in each rank as there are processors.
/// @note   Collective on all ranks.
void share_processors();

}  // namespace chladni::linear
