// CMSSolve: basis, projection, errors, count.
#include <algorithm>
#include <cmath>
#include <limits>
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
                .estimates = {},
                .rounding = {},
                .residuals = {0, 0},
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
    ErrorEstimates errors = error_estimates(
        {.K_ss = set_up.K_ss, .Q_CB = result.Q_CB, .K = set_up.K_blocks, .M = set_up.M_blocks},
        pairs, cms->inside->settings.sylvester ? Purpose::bounds : Purpose::estimates);
    const bool leaves_out_modes = cms->inside->settings.options.method == Method::craig_bampton;
    result.estimates =
        frequency_errors_by_place(pairs.lambda, errors.eta2,
                                  leaves_out_modes ? std::pow(result.model.omega.back(), 2)
                                                   : std::numeric_limits<double>::infinity());
    result.eta2 = std::move(errors.eta2);
    result.rounding = std::move(errors.rounding);
    result.residuals = std::move(errors.inner_products);
  }
  for (const double lambda : pairs.lambda) result.f_Hz.push_back(std::sqrt(lambda) / two_pi);
  result.lambda = free.lambda;
  result.quality.n_zero = free.n_zero;
  result.quality.rigid_residual = free.rigid_residual;
  phase.done();
  return result;
}

/// Counts the fixed-interface modes up to the last one, and the free model in the certified range;
/// a complete count gives error bounds.
void count(CMS cms, Result& result)
{
  Phase phase(cms, events.count, "count of eigenvalues");
  const SetUp& set_up = *cms->inside->set_up;
  const OptionSource& source = set_up.K_ss.options().petsc;
  if (cms->inside->settings.options.method == Method::craig_bampton) {
    result.quality.modes = as_count(count_fixed_interface(result.model.omega, [&](double sigma) {
      return eigenvalues_below(set_up.K_blocks.ss, set_up.M_blocks.ss, sigma, source);
    }));
  }
  Completeness certified = count_modes(
      {.lambda = result.lambda,
       .residuals = result.residuals,
       .n_zero = result.quality.n_zero,
       .comm = PetscObjectComm(reinterpret_cast<PetscObject>(cms))},
      [&](double sigma) { return eigenvalues_below(set_up.K, set_up.M, sigma, source); });
  result.quality.model = as_count(certified.range);
  result.quality.complete = as_count(certified.complete);
  result.bounds = std::move(certified.bounds);
  for (std::size_t i = 0; i < result.bounds.size(); ++i) {
    result.bounds[i] += result.rounding[i];
    result.estimates[i] = std::min(result.estimates[i], 0.5 * result.bounds[i]);
  }
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
