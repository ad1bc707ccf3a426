#pragma once

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// Whether K and M are needed once there is the factor of K_ss.
bool needs_matrices(const ReductionOptions& options, bool counts);

/// What this rank takes beside the factor of K_ss, at the phase that takes most: in columns of its
/// slaves the basis of block Lanczos with the modes that come out of it, or Psi and Phi with what
/// error estimates or the caller work in; or all of these with the factor that counts eigenvalues
/// where that is asked for.
class MemoryForecast {
 public:
  /// Before the factor and before K and M are given back.
  MemoryForecast(const Body& body, Mat K_ss, Mat M_ss, const ReductionOptions& options);

  /// With as many modes as are asked for; of a cut-off or a tolerance the modes to begin with.
  linear::FactorOptions at_first(linear::FactorOptions factor) const;
  /// Before a search that does not know its number of modes goes on.
  /// @note   Collective.
  /// @throws chladni::Error on all ranks when factor and so many modes do not fit into the memory
  ///         that was free before the factorisation.
  void require(Mat factor, PetscInt n_modes) const;

 private:
  double beside_MiB(double n_modes) const;
  double columns_in_estimates(double n_modes) const;
  linear::SecondFactor second(double n_modes) const;

  ReductionOptions options_;
  double basis_columns(double n_modes) const;

  double largest_part_ = 1.0;   ///< of the slaves, where parts are solved for by themselves
  double mass_of_parts_ = 0.0;  ///< MiB
  double n_masters_, n_slaves_, column_MiB_, K_MiB_, M_MiB_, let_go_MiB_;
};

}  // namespace chladni::reduce
