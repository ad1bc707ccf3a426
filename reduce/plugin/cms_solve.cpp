// CMSSolve: the reduction, and what C programs read of its certificate.
#include <cmath>
#include <numbers>

#include "reduce/plugin/cms_impl.hpp"
#include "reduce/plugin/free_masters.hpp"

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

CMSQuality quality_of(const Certificate& certificate)
{
  return {.n_zero = certificate.n_zero,
          .rigid_residual = certificate.zero_energy,
          .condition = certificate.condition,
          .modes = as_count(certificate.fixed_interface),
          .model = as_count(certificate.range),
          .complete = as_count(certificate.complete)};
}

}  // namespace

Result make_result(CMS cms)
{
  CMSPhases phases(cms);
  Inside& in = *cms->inside;
  Result result{.reduction = reduction(in.set_up->body, in.settings.options, FreeMasters(), phases),
                .f_Hz = {},
                .quality = {}};
  const Certificate& certificate = result.reduction.certificate;
  for (const double lambda : certificate.lambda) result.f_Hz.push_back(std::sqrt(lambda) / two_pi);
  result.quality = quality_of(certificate);
  return result;
}

}  // namespace chladni::reduce::plugin
