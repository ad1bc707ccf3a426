#pragma once

#include <functional>
#include <vector>

#include "linear/cholesky/factorization.hpp"
#include "reduce/reduce_options.hpp"

namespace chladni::reduce {

/// K_ss Phi = M_ss Phi diag(omega^2), Phi^T M_ss Phi = I: vibrations with all masters held.
struct FixedInterfaceModes {
  petsc::Matrix Phi;          ///< [n_s x n] dense, rows as K_ss; 1/sqrt(kg)
  std::vector<double> omega;  ///< [n] rad/s, ascending
};

/// Throws on all ranks where a basis for so many modes does not fit into the memory.
using MemoryCheck = std::function<void(PetscInt n_modes)>;

/// The lowest modes, by number or up to a frequency, with the factor of K_ss as shift-and-invert
/// operator at shift 0 (M_ss may be singular): by block Lanczos, or by SLEPc's Krylov-Schur. Modes
/// closer than 1e-4 in frequency stay together: where the last one wanted has such a partner, that
/// comes too.
/// @note   Collective on the communicator of `M_ss`.
/// @throws chladni::Error when the solver does not converge or more modes are asked than exist.
/// The solver is that of the options of `K_ss`; `-<prefix>eps_...` are those of Krylov-Schur.
FixedInterfaceModes fixed_interface_modes(const linear::Factorization& K_ss, Mat M_ss,
                                          const ReduceOptions& wanted,
                                          const MemoryCheck& require_memory = {});

/// The worst of |K phi - lambda M phi| / |lambda M phi| over the modes: what the eigen-solver left,
/// by the matrices themselves.
/// @note   Collective.
double largest_residual(const FixedInterfaceModes& modes, Mat K_ss, Mat M_ss);

}  // namespace chladni::reduce
