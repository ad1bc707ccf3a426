// CMSSolve: the reduction, and what C programs read of its certificate.
#include <cmath>
#include <numbers>

#include "plugin/cms_impl.hpp"
#include "reduce/held_masters.hpp"

namespace chladni::plugin {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

CMSCount as_count(const reduce::EigenvalueCount& count)
{
  return {.upto = std::sqrt(count.sigma) / two_pi,
          .expected = count.expected,
          .found = count.found,
          .missing = count.missing()};
}

CMSQuality quality_of(const reduce::Certificate& certificate)
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
  const reduce::HeldMasters support(in.set_up->body.masters, held_masters(in));
  Result result{
      .reduction = reduce::reduction(in.set_up->body, in.settings.options, support, phases),
      .f_Hz = {},
      .quality = {}};
  const reduce::Certificate& certificate = result.reduction.certificate;
  for (const double lambda : certificate.lambda) result.f_Hz.push_back(std::sqrt(lambda) / two_pi);
  result.quality = quality_of(certificate);
  return result;
}

}  // namespace chladni::plugin
