#pragma once

namespace chladni::linear {

/// OpenBLAS 0.3.21 takes its slowest kernels (SSE3) on processors younger than itself, which costs
/// a third of a reduction. Where that happens, starts this program anew with OPENBLAS_CORETYPE set
/// to kernels that the processor has; otherwise, and where the variable is set already, returns.
/// @note   To be called first in main, before MPI starts.
void restart_with_fitting_blas_kernels(char** argv);

/// Divides the processors of this machine among its ranks, where the environment says nothing of
/// threads: OpenBLAS would start as many in each rank as there are processors.
/// @note   Collective on all ranks.
void share_processors();

}  // namespace chladni::linear
