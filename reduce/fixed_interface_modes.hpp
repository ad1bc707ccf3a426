#pragma once

#include <functional>
#include <vector>

#include "linear/cholesky/factorization.hpp"
#include "reduce/reduce_options.hpp"

namespace chladni::reduce {

/// Modes with all masters held: K_ss Phi = M_ss Phi diag(omega^2), Phi^T M_ss Phi = I.
struct FixedInterfaceModes {
  petsc::Matrix Phi;          ///< [n_s x n] dense, rows as K_ss; 1/sqrt(kg)
  std::vector<double> omega;  ///< [n] rad/s, ascending
};

/// A function that throws on all ranks when a basis of so many modes does not fit into the memory.
using MemoryCheck = std::function<void(PetscInt n_modes)>;

/// The lowest modes, by number or up to a frequency, by block Lanczos or by SLEPc's Krylov-Schur
/// (the choice is in the options of `K_ss`). The factor of K_ss is the shift-and-invert operator at
/// shift 0; M_ss may be singular. Modes within a relative distance of 1e-4 in frequency stay
/// together: if the last one wanted has such neighbours, these are returned too.
/// @note   Collective on the communicator of `M_ss`.
/// @throws chladni::Error when the solver does not converge or more modes are asked than exist.
/// Options: `-<prefix>eps_...` for Krylov-Schur
FixedInterfaceModes fixed_interface_modes(const linear::Factorization& K_ss, Mat M_ss,
                                          const ReduceOptions& wanted,
                                          const MemoryCheck& require_memory = {});

/// The largest |K phi - lambda M phi| / |lambda M phi| of the modes: the error that the
/// eigen-solver left, measured with the matrices themselves.
/// @note   Collective.
double largest_residual(const FixedInterfaceModes& modes, Mat K_ss, Mat M_ss);

}  // namespace chladni::reduce
