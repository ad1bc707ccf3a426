#include "reduce/memory_forecast.hpp"

#include <algorithm>

#include "linear/machine_memory.hpp"
#include "reduce/basis.hpp"
#include "reduce/certify.hpp"

namespace chladni::reduce {

namespace {

/// Fixed-interface modes to begin with: a cut-off and a tolerance find out how many they need, and
/// look at the memory again when their basis grows.
double modes_at_first(const ReduceOptions& wanted)
{
  if (wanted.method == Method::guyan) return 0.0;
  constexpr double unknown = 40.0;
  return wanted.modes ? *wanted.modes : unknown;
}

double own_MiB(Mat A)
{
  MatInfo info{};
  petsc::check(MatGetInfo(A, MAT_LOCAL, &info));
  constexpr double for_each_entry = sizeof(PetscScalar) + sizeof(PetscInt);
  return for_each_entry * info.nz_used / linear::bytes_in_MiB;
}

}  // namespace

bool needs_matrices(const ReductionOptions& options, bool counts)
{
  return options.keeps_matrices || counts || is_free_interface(options.basis.method);
}

linear::FactorOptions with_what_comes_beside(linear::FactorOptions factor, const Body& body,
                                             Mat K_ss, const ReductionOptions& options)
{
  PetscInt n_local = 0, n_s = 0;
  petsc::check(MatGetLocalSize(K_ss, &n_local, nullptr));
  petsc::check(MatGetSize(K_ss, &n_s, nullptr));
  constexpr double basis_for_each_mode = 2.1, least_basis = 40.0, blocks_of_lanczos = 56.0;
  constexpr double in_estimates = 230.0;
  const double n_modes = std::min<double>(modes_at_first(options.basis), n_s);
  const double basis = std::min<double>(basis_for_each_mode * n_modes + least_basis, n_s);
  const double in_search = n_modes > 0.0 ? basis + n_modes + blocks_of_lanczos : 0.0;
  const double kept = static_cast<double>(body.masters.size()) + n_modes;
  const bool counts = options.count.value_or(false);
  const double bounds = counts ? std::min(n_modes, 100.0) : 0.0;  // residuals
  const double later = options.later_columns + options.later_columns_for_each_mode * n_modes;
  const double in_MiB = sizeof(double) * double(n_local) / linear::bytes_in_MiB;
  const double let_go = needs_matrices(options, counts) ? 0.0 : own_MiB(body.K) + own_MiB(body.M);
  factor.beside_MiB =
      in_MiB * std::max(in_search, kept + std::max(in_estimates + bounds, later)) - let_go;
  if (counts) factor.second = {.entries = entries_of_counting_factor, .beside_MiB = in_MiB * kept};
  return factor;
}

}  // namespace chladni::reduce
