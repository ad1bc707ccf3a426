#include "squeal/transient/windowed_sinc.hpp"

#include <cmath>
#include <numbers>

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Cutoff over the highest frequency that the lower rate holds. With a Blackman window what lies
/// more than 6 / n_sinc_zeros of half the cutoff beyond it is lowered by 74 dB: the pass band ends
/// 1 / 8 below the cutoff, and the stop band begins about there above it.
constexpr double cutoff_part = 0.87;

}  // namespace

double half_width_of_sinc(double nyquist)
{
  return n_sinc_zeros / (2.0 * cutoff_part * nyquist);
}

double windowed_sinc(double nyquist, double time)
{
  const double cutoff = cutoff_part * nyquist, x = 2.0 * cutoff * time;
  const double u = x / n_sinc_zeros;  // -1 to 1
  if (!(std::abs(u) < 1.0)) return 0.0;
  const double sinc = x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x);
  const double window = 0.42 + 0.5 * std::cos(pi * u) + 0.08 * std::cos(2.0 * pi * u);
  return 2.0 * cutoff * sinc * window;
}

}  // namespace chladni::squeal
