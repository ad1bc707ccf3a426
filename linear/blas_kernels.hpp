#pragma once

namespace chladni::linear {

/// Lets OpenBLAS choose anew among its kernels, with OPENBLAS_CORETYPE set to those that the
/// processor supports, if it has chosen its slowest ones (SSE3). OpenBLAS 0.3.21 does so on
/// processors newer than itself, which slows a reduction by a third. A library that cannot choose
/// twice is given the variable by restarting this program. Does nothing if the variable is set.
/// @note   To be called first in main, before MPI starts.
void take_fitting_blas_kernels(char** argv);

/// Divides the processors of this machine among its ranks, unless the environment sets a number of
/// threads. OpenBLAS would start as many threads in each rank as there are processors.
/// @note   Collective on all ranks.
void share_processors();

}  // namespace chladni::linear
