// CMSSolve: basis, projection, errors, count.
#include <cmath>
#include <numbers>

#include "reduce/completeness.hpp"
#include "reduce/plugin/cms_impl.hpp"
#include "reduce/plugin/free_model.hpp"
#include "reduce/sylvester.hpp"

namespace chladni::reduce::plugin {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

CMSCount as_count(const EigenvalueCount& count)
{
  return {.upto = std::sqrt(count.sigma) / two_pi,
          .expected = count.expected,
          .found = count.found,
          .missing = count.missing()};
}

/// The projection on a basis, with errors of its free modes.
Result reduced(CMS cms, Basis basis)
{
  const SetUp& set_up = *cms->inside->set_up;
  Result result{.Q_CB = std::move(basis.Q),
                .model = {.K = {0, 0}, .M = {0, 0}, .n_masters = 0, .omega = {}},
                .lambda = {},
                .f_Hz = {},
                .eta2 = {},
                .bounds = {},
                .quality = {},
                .K_r = {},
                .M_r = {},
                .C_r = {},
                .T = {}};
  {
    Phase phase(cms, events.project, "projection");
    result.model = project(result.Q_CB, set_up.K_blocks, set_up.M_blocks);
    if (basis.mass) result.model.M = *basis.mass;
    phase.done();
  }
  Phase phase(cms, events.errors, "error estimates");
  const FreeModel free =
      free_model_everywhere(result.model, PetscObjectComm(reinterpret_cast<PetscObject>(cms)));
  const ReducedPairs pairs = certified_pairs(free, cms->inside->settings, result.model);
  if (!pairs.lambda.empty() && !basis.mass) {  // residuals tell of projections only
    result.eta2 = error_estimates(set_up.K_ss, result.Q_CB, set_up.M_blocks, pairs);
  }
  for (const double lambda : pairs.lambda) result.f_Hz.push_back(std::sqrt(lambda) / two_pi);
  result.lambda = free.lambda;
  result.quality.n_zero = free.n_zero;
  result.quality.rigid_residual = free.rigid_residual;
  phase.done();
  return result;
}

/// Counts the fixed-interface modes up to the last one, and the free model in the certified range;
/// a complete count makes the error bounds rigorous.
void count(CMS cms, Result& result)
{
  Phase phase(cms, events.count, "count of eigenvalues");
  const SetUp& set_up = *cms->inside->set_up;
  if (cms->inside->settings.options.method == Method::craig_bampton) {
    constexpr double half_a_pair_gap = 1e-4;  // of lambda: modes that close are never cut apart
    const double sigma = std::pow(result.model.omega.back(), 2) * (1.0 + half_a_pair_gap);
    const PetscInt n = eigenvalues_below(set_up.K_blocks.ss, set_up.M_blocks.ss, sigma);
    result.quality.modes = as_count(
        {.sigma = sigma, .expected = n, .found = static_cast<int>(result.model.omega.size())});
  }
  Completeness certified =
      count_modes({.lambda = result.lambda, .eta2 = result.eta2, .n_zero = result.quality.n_zero},
                  [&](double sigma) { return eigenvalues_below(set_up.K, set_up.M, sigma); });
  result.quality.model = as_count(certified.range);
  result.quality.complete = as_count(certified.complete);
  result.bounds = std::move(certified.bounds);
  phase.done();
}

}  // namespace

Result make_result(CMS cms)
{
  Result result = reduced(cms, make_basis(cms));
  result.quality.condition = condition_estimate(cms->inside->set_up->K_ss);
  if (cms->inside->settings.sylvester) count(cms, result);
  return result;
}

}  // namespace chladni::reduce::plugin
