#pragma once

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// Whether K and M are needed once there is the factor of K_ss.
bool needs_matrices(const ReductionOptions& options, bool counts);

/// What this rank takes beside the factor of K_ss, at the phase that takes most: in columns of its
/// slaves the basis of block Lanczos with the modes that come out of it, or Psi and Phi with what
/// error estimates or the caller work in; or all of these with the factor that counts eigenvalues
/// where that is asked for. The numbers are measured.
linear::FactorOptions with_what_comes_beside(linear::FactorOptions factor, const Body& body,
                                             Mat K_ss, const ReductionOptions& options);

}  // namespace chladni::reduce
