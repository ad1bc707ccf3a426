#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "squeal/cycle/periodic_orbit.hpp"

namespace chladni::squeal {

/// Tolerances of the integration of a periodic motion: the first, the factor to the next, and the
/// last, beyond which rounding is larger.
inline constexpr double first_tolerance = 1e-9;
inline constexpr double tolerance_factor = 1e-2;
inline constexpr double last_tolerance = 1e-13;

/// Whether no smaller tolerance follows; powers of the factor are rounded.
inline bool is_last(double tolerance)
{
  return tolerance < 2.0 * last_tolerance;
}

/// With the error that the integration of the orbit causes in its multipliers: some tolerances,
/// magnified by 1 / |mu - 1|; four of them for the normal form of a fold.
inline PeriodicOrbit with_error_of_orbit(PeriodicOrbit orbit)
{
  FloquetMultipliers& multipliers = orbit.multipliers;
  multipliers.error += 10.0 * orbit.tolerance * multipliers.condition / multipliers.distance();
  return orbit;
}

/// The orbit at which steps change the distance of the largest multiplier from 1 by less than a
/// hundredth; absent when there is none, as beside a fold that the tolerance does not resolve.
/// @param step  the orbit after a step from another one, with the multipliers of that
/// @return with the last change of the largest multiplier in its error
template <class Step>
std::optional<PeriodicOrbit> settled_orbit(const PeriodicOrbit& near, const Step& step)
{
  constexpr int steps_max = 4;
  // The multipliers of the first are those of the place where the steps begin.
  std::optional<PeriodicOrbit> orbit = step(near.at);
  int n_newton_steps = near.n_newton_steps + 1;
  for (int i = 0; orbit && i < steps_max; ++i) {
    auto next = step(orbit->at);
    if (!next) return std::nullopt;
    next->n_newton_steps = ++n_newton_steps;
    const double change = std::abs(next->multipliers.largest() - orbit->multipliers.largest());
    if (change <= 0.01 * next->multipliers.distance()) {
      next->multipliers.error += change;
      return next;
    }
    orbit = std::move(next);
  }
  return std::nullopt;
}

/// The orbit at a tolerance at which its stability is told, if there is one, with the difference to
/// the tolerance before in the error of its multipliers.
/// @param step  the orbit after a step at a tolerance of the integration; absent when none is found
template <class Step>
PeriodicOrbit with_verdict(const PeriodicOrbit& first, const Step& step)
{
  PeriodicOrbit orbit = with_error_of_orbit(first);
  if (orbit.multipliers.is_told()) return orbit;
  double tolerance = orbit.tolerance;
  const auto settled = [&] {
    return settled_orbit(orbit, [&](const CycleStart& from) { return step(from, tolerance); });
  };
  std::optional<PeriodicOrbit> now = settled();
  if (now && is_last(tolerance)) return with_error_of_orbit(std::move(*now));
  while (now && !is_last(tolerance)) {
    orbit = std::move(*now);
    tolerance *= tolerance_factor;
    now = settled();
    if (!now) break;
    now->multipliers.error += std::abs(now->multipliers.largest() - orbit.multipliers.largest());
    if (now->multipliers.is_told()) return *now;
  }
  if (now) return *now;
  // The orbit hardly exists, so that its multipliers are not known either.
  orbit.multipliers.error = std::max(orbit.multipliers.error, orbit.multipliers.distance());
  return orbit;
}

}  // namespace chladni::squeal
