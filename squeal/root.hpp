#pragma once

#include <algorithm>
#include <cmath>

namespace chladni::squeal {

/// Root of a continuous function between `low`, where it is negative, and `high`, where it is
/// positive, by regula falsi with the Illinois rule: the value at an end that remains twice is
/// halved.
/// @param tolerance  relative change of the root at which the iteration ends
template <class Function>
double root(const Function& f, double low, double high, double tolerance = 1e-14)
{
  double f_low = f(low), f_high = f(high), last = low;
  int stay = 0;  // > 0: `high` stayed, < 0: `low` stayed
  for (int i = 0; i < 100; ++i) {
    const double x = (low * f_high - high * f_low) / (f_high - f_low);
    const double f_x = f(x);
    if (f_x == 0.0 || std::abs(x - last) <= tolerance * x) return x;
    last = x;
    if (f_x < 0.0) {
      low = x;
      f_low = f_x;
      stay = std::max(stay, 0) + 1;
      if (stay > 1) f_high *= 0.5;
    } else {
      high = x;
      f_high = f_x;
      stay = std::min(stay, 0) - 1;
      if (stay < -1) f_low *= 0.5;
    }
  }
  return last;
}

}  // namespace chladni::squeal
