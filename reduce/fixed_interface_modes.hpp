#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "linear/cholesky/factorization.hpp"
#include "linear/lanczos/parted_lanczos.hpp"
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

/// Finds the lowest fixed-interface modes, step by step more of them. The factor of K_ss is the
/// shift-and-invert operator at shift 0. Block Lanczos continues where it stopped, SLEPc's
/// Krylov-Schur starts again.
/// Options: as `fixed_interface_modes`
class ModeSearch {
 public:
  /// K_ss and M_ss must outlive the search. The eigen-solver is that of the options of `K_ss`.
  ModeSearch(const linear::Factorization& K_ss, Mat M_ss, MemoryCheck require_memory = {});

  /// Number of slaves, which bounds the number of modes.
  PetscInt n_slaves() const { return n_s_; }
  /// Finds the lowest n modes, or all if there are fewer, and continues until the last cluster of
  /// close modes is complete.
  /// @note   Collective.
  /// @throws chladni::Error when the solver does not converge, K_ss is not positive definite, or
  ///         the memory does not suffice.
  void find(PetscInt n);
  /// Checks that all modes below lambda have converged.
  /// @param lambda  rad^2/s^2
  /// @throws chladni::Error when a mode below lambda may be missing although all that converge are
  ///         found.
  void require_resolved(double lambda) const
  {
    if (lanczos_) lanczos_->require_resolved(lambda);
  }
  /// rad^2/s^2; above this value there may be modes that do not converge. Infinity if there are
  /// none.
  double unresolved_from() const
  {
    return lanczos_ ? lanczos_->unresolved_from() : linear::all_of_them;
  }
  /// Number of parts that K_ss and M_ss do not couple. Each is solved separately.
  PetscInt n_parts() const { return lanczos_ ? lanczos_->n_parts() : 1; }
  /// True when all modes of the pencil have been found.
  bool has_all() const { return has_all_; }
  /// Angular frequencies of the modes found, rad/s, ascending.
  const std::vector<double>& omega() const { return omega_; }
  /// n, raised until the gap to the next mode is more than 1e-4 in frequency.
  PetscInt complete_cluster(PetscInt n) const;
  /// Phi of the modes first .. last - 1, [n_s x last - first] dense.
  /// @note   Collective.
  petsc::Matrix shapes(PetscInt first, PetscInt last) const;
  /// The first n modes.
  /// @note   Collective.
  FixedInterfaceModes leading(PetscInt n) const;

 private:
  void find_all(PetscInt n);
  void find_by_krylov_schur(PetscInt n);

  const linear::Factorization& K_ss_;
  Mat M_ss_;
  MemoryCheck require_memory_;
  PetscInt n_s_ = 0;
  std::optional<linear::PartedLanczos> lanczos_;  ///< empty with SLEPc's solver
  petsc::Matrix X_;                               ///< all vectors of SLEPc's solver
  std::vector<double> omega_;
  bool has_all_ = false;
};

}  // namespace chladni::reduce
