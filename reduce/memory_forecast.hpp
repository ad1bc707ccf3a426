#pragma once

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// True when K and M are needed after K_ss is factored: the caller keeps them, eigenvalues are
/// counted, or the method has free masters.
bool needs_matrices(const ReductionOptions& options, bool counts);

/// True when K and M are not even needed while K_ss is factored: whether eigenvalues are counted
/// does not depend on its factor.
bool lets_matrices_go_at_once(const ReductionOptions& options);

/// Predicts the memory that this rank needs beside the factor of K_ss in the most expensive phase.
/// That is the basis of block Lanczos with the modes it returns, or Psi and Phi with the workspace
/// of error estimates or of the caller, or these with the factor that counts eigenvalues, where a
/// count is asked for.
class MemoryForecast {
 public:
  /// To be called before K_ss is factored and while K and M are there.
  /// @param K, M  their blocks
  MemoryForecast(const Body& body, const Blocks& K, const Blocks& M,
                 const ReductionOptions& options);

  /// Adds the forecast to the options of the factor: for the number of modes asked for, or, with a
  /// cut-off or a tolerance, for the number that a search begins with.
  linear::FactorOptions at_first(linear::FactorOptions factor) const;
  /// To be called before a search goes on to n_modes modes, where their number is not given.
  /// @note   Collective.
  /// @throws chladni::Error on all ranks when the factor and so many modes do not fit into the
  ///         memory that was free before the factorisation.
  void require(Mat factor, PetscInt n_modes) const;

 private:
  double beside_MiB(double n_modes) const;
  double columns_in_search(double n_modes) const;
  double columns_in_estimates(double n_modes) const;
  linear::SecondFactor second(double n_modes) const;

  double basis_columns(double n_modes) const;
  void take_parts(Mat K, Mat M, Mat K_sm);

  ReductionOptions options_;
  double largest_part_ = 1.0;   ///< share of the rows in the largest uncoupled part
  double part_of_Psi_ = 1.0;    ///< share of its entries in parts that their masters move
  double mass_of_parts_ = 0.0;  ///< MiB
  double n_masters_, n_slaves_, column_MiB_, K_MiB_, M_MiB_, let_go_MiB_;
  double columns_at_a_time_;  ///< of the estimates
  /// Share of modes, constraint modes and bases in memory: none where they are in scratch files.
  double in_memory_ = 1.0;
};

}  // namespace chladni::reduce
