#pragma once

#include <optional>
#include <vector>

#include "linear/lanczos/parted_lanczos.hpp"
#include "reduce/fixed_interface_modes.hpp"

namespace chladni::reduce {

/// The lowest fixed-interface modes, ever more of them, with the factor of K_ss as shift-and-invert
/// operator at shift 0: block Lanczos goes on where it stopped, SLEPc's Krylov-Schur begins anew.
/// Options: as `fixed_interface_modes`
class ModeSearch {
 public:
  /// Both must outlive the search. The eigen-solver is that of the options of `K_ss`.
  ModeSearch(const linear::Factorization& K_ss, Mat M_ss, MemoryCheck require_memory = {});

  /// Number of slaves, which bounds the number of modes.
  PetscInt n_slaves() const { return n_s_; }
  /// Finds the lowest n, or all where there are fewer, and more until the last partner is seen.
  /// @note   Collective.
  /// @throws chladni::Error when the solver does not converge, K_ss is not definite, or the memory
  ///         does not suffice.
  void find(PetscInt n);
  /// @throws chladni::Error when modes below that lambda may not be among those found, which are
  ///         all that converge.
  void require_resolved(double lambda) const
  {
    if (lanczos_) lanczos_->require_resolved(lambda);
  }
  /// The lambda from which on there may be modes that do not converge; infinity without any.
  double unresolved_from() const
  {
    return lanczos_ ? lanczos_->unresolved_from() : linear::all_of_them;
  }
  /// Parts that K_ss and M_ss do not couple, each solved for by itself.
  PetscInt n_parts() const { return lanczos_ ? lanczos_->n_parts() : 1; }
  /// Whether all modes that there are have been found.
  bool has_all() const { return has_all_; }
  /// Angular frequencies of all that are found, ascending; rad/s.
  const std::vector<double>& omega() const { return omega_; }
  /// The first n modes and those that follow within 1e-4 in frequency.
  PetscInt complete_cluster(PetscInt n) const;
  /// Phi of modes first .. last - 1.
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
  std::optional<linear::PartedLanczos> lanczos_;  ///< nothing where SLEPc is asked for
  petsc::Matrix X_;                               ///< then all vectors that it found
  std::vector<double> omega_;
  bool has_all_ = false;
};

}  // namespace chladni::reduce
