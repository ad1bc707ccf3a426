#include "reduce/method_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "linear/cholesky/cholesky_types.hpp"

namespace chladni::reduce {

namespace {

/// What a vector of the eigen-solve with free masters costs beside one with all of them held:
/// after the solution with the factor of K_ss the masters are let go, by K_G^-1 and Psi.
double cost_of_free_masters(const FactoredBody& body)
{
  // Products of dense matrices run at the rate of the processor, solutions at that of the memory.
  constexpr double dense_over_solution = 1.0 / 6.0;
  PetscInt n_slaves = 0;
  petsc::check(MatGetSize(body.K_blocks.ss, &n_slaves, nullptr));
  const auto n_masters = double(body.masters.size());
  const double solution = 4.0 * linear::factor_size(body.K_ss.factor()).entries;
  const double product = 2.0 * n_masters * (double(n_slaves) + n_masters);
  return 1.0 + dense_over_solution * product / solution;
}

/// How many more fixed-interface modes than modes of the range keep a tolerance where masters are
/// free that the fixed interface holds: less than what was found on discs and beams (1.5 to 2.1 at
/// 1e-2, 1.6 to 7.5 at 1e-3, 2.5 to 16 at 1e-4), so that what is taken for cheaper is so.
double modes_beyond_range(double tolerance)
{
  constexpr double at_a_hundredth = 1.5;
  return at_a_hundredth * std::max(1.0, std::pow(1e-2 / tolerance, 0.25));
}

}  // namespace

MethodChoice method_choice(const FactoredBody& body, const ReductionOptions& options,
                           const Support& support)
{
  const ReduceOptions& wanted = options.basis;
  if (wanted.method != Method::automatic) return {.method = wanted.method};
  if (!wanted.tolerance) {
    throw Error(
        "reduce: an automatic choice of the method needs a tolerance; give a tolerance with its "
        "range, or a method");
  }
  const auto n_masters = double(body.masters.size());
  const double n_free = n_masters - double(support.held().size());
  if (n_free == 0.0) {
    return {.method = Method::craig_bampton,
            .reason = "the support holds all masters, as the fixed interface does"};
  }
  const double for_each_mode = cost_of_free_masters(body);
  const double more_modes = modes_beyond_range(wanted.tolerance->tolerance);
  if (for_each_mode <= more_modes) {
    return {
        .method = Method::mixed_interface,
        .reason = fmt::format("{:.0f} of {:.0f} masters are free: their modes cost {:.1f} times "
                              "as much as fixed-interface modes, of which at least {:.1f} times "
                              "as many would be needed",
                              n_free, n_masters, for_each_mode, more_modes)};
  }
  return {
      .method = Method::craig_bampton,
      .reason = fmt::format("with {:.0f} masters modes that leave them free cost {:.1f} times as "
                            "much as fixed-interface modes, of which {:.1f} times as many may do",
                            n_masters, for_each_mode, more_modes)};
}

}  // namespace chladni::reduce
