#include "squeal/cycle/periodic_orbit.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "squeal/motion/dormand_prince.hpp"
#include "squeal/stability/eigenvalues.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

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

/// Parts of the period of the fastest mode for a step of the integration at most, and for one
/// exponential.
constexpr double steps_per_period_min = 6.0;
constexpr double exponentials_per_period = 36.0;
/// Of the derivatives that only lead Newton's method, whose errors of 1e-3 it outruns.
constexpr double rough_exponentials_per_period = 12.0;
constexpr double defect_max = 1e-6;
constexpr int orbit_newton_steps_max = 25;
/// Change of x_0, relative, from which on the step with the fine derivative is the last one: it
/// leaves the square of what the one before left.
constexpr double nearly_converged = 1e-5;
/// Largest change of x_0, relative, by a step that settles an orbit beside a fold or a Hopf point.
constexpr double settling_change = 1e-2;
/// Largest change of x_0 in one step, relative.
constexpr double largest_change_of_orbit = 0.5;
/// A derivative that does not reduce the change by this factor is computed anew.
constexpr double orbit_worn_out = 0.1;

/// Of the longest step, relative to that at the first tolerance.
double shortening(double tolerance)
{
  return std::min(1.0, std::pow(tolerance / first_tolerance, 0.125));
}

StepControl control_of(const AutonomousMotion& motion, double tolerance)
{
  const double longest =
      shortening(tolerance) * 2.0 * pi / (motion.omega_highest() * steps_per_period_min);
  return {tolerance, longest, 0.25 * longest};
}

std::vector<double> sides_of(const AutonomousMotion& motion)
{
  std::vector<double> sides;
  for (Eigen::Index i = 0; i < motion.switches().size(); ++i) sides.push_back(motion.side(i));
  return sides;
}

void set_sides(AutonomousMotion& motion, const std::vector<double>& sides)
{
  for (std::size_t i = 0; i < sides.size(); ++i)
    motion.set_side(static_cast<Eigen::Index>(i), sides[i]);
}

/// exp(h / 2 (A_1 + A_2) + sqrt(3) h^2 / 12 [A_2, A_1]) with A at the two Gauss points of a step.
Eigen::MatrixXd magnus(const Eigen::MatrixXd& A_1, const Eigen::MatrixXd& A_2, double h)
{
  const Eigen::MatrixXd exponent =
      0.5 * h * (A_1 + A_2) + std::sqrt(3.0) / 12.0 * h * h * (A_2 * A_1 - A_1 * A_2);
  return exponent.exp();
}

/// How many exponentials a derivative takes.
struct Exponentials {
  double per_radian;  ///< for a time of 1 / omega_highest
  int per_step;       ///< of the integration at least: it is short where f bends
};

/// Of order 4 beside an integration of order 8.
Exponentials fine(double tolerance)
{
  return {exponentials_per_period / (2.0 * pi * shortening(tolerance)), 2};
}

constexpr Exponentials rough{rough_exponentials_per_period / (2.0 * pi), 1};

/// The derivative over a span within one step of the integrator, of which it interpolates.
Eigen::MatrixXd derivative_over(AutonomousMotion& motion, DormandPrince& orbit,
                                const DormandPrince::Span& span, const Exponentials& exponentials)
{
  const double length = span.end - span.begin;
  const int n = std::max(
      exponentials.per_step,
      static_cast<int>(std::ceil(exponentials.per_radian * motion.omega_highest() * length)));
  const double h = length / n, gauss = std::sqrt(3.0) / 6.0;
  Eigen::MatrixXd X = Eigen::MatrixXd::Identity(motion.size(), motion.size());
  for (int i = 0; i < n; ++i) {
    const double middle = span.begin + (i + 0.5) * h;
    const Eigen::MatrixXd A_1 = motion.jacobian(orbit.at(middle - gauss * h));
    const Eigen::MatrixXd A_2 = motion.jacobian(orbit.at(middle + gauss * h));
    X = magnus(A_1, A_2, h) * X;
  }
  return X;
}

Flow flow_with(AutonomousMotion& motion, const CycleStart& start, double tolerance,
               const Exponentials& exponentials)
{
  DormandPrince orbit(motion, 0.0, start.x, control_of(motion, tolerance));
  Flow result{start.x, Eigen::MatrixXd::Identity(start.x.size(), start.x.size())};
  std::vector<double> sides = sides_of(motion);
  for (double t = 0.0; t < start.period;) {
    const DormandPrince::Span step = orbit.next_step();
    if (!orbit.at(step.end).allFinite()) return {orbit.at(step.end), result.derivative};
    const std::vector<double> next = sides_of(motion);
    set_sides(motion, sides);
    const double end = std::min(step.end, start.period);
    if (end > step.begin) {
      result.derivative =
          derivative_over(motion, orbit, {step.begin, end}, exponentials) * result.derivative;
    }
    result.end = orbit.at(end);
    set_sides(motion, next);
    sides = next;
    t = step.end;
  }
  return result;
}

/// What `integrate` returns, or `otherwise` where it is stuck in a contact.
template <class Integrate, class Result>
Result unless_stuck(const Integrate& integrate, Result otherwise)
{
  try {
    return integrate();
  } catch (const StuckContact&) {
    return otherwise;
  }
}

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

Flow flow_or_nowhere(AutonomousMotion& motion, const CycleStart& start, double tolerance,
                     const Exponentials& exponentials)
{
  const Eigen::Index n = start.x.size();
  return unless_stuck([&] { return flow_with(motion, start, tolerance, exponentials); },
                      Flow{Eigen::VectorXd::Constant(n, nowhere), Eigen::MatrixXd::Identity(n, n)});
}

/// A Newton step (dx, dT / T) from the end of a flow:
/// [X - I, T f(x_T); T f(x_0)^T, 0] (dx, dT / T) = (x_0 - x_T, 0).
Eigen::VectorXd newton_step(AutonomousMotion& motion, const CycleStart& at, const Flow& flow)
{
  const Eigen::Index n = at.x.size();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n + 1, n + 1);
  J.topLeftCorner(n, n) = flow.derivative - Eigen::MatrixXd::Identity(n, n);
  J.col(n).head(n) = at.period * motion.rate_at(flow.end);
  J.row(n).head(n) = at.period * motion.rate_at(at.x).transpose();
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(n + 1);
  residual.head(n) = at.x - flow.end;
  return J.partialPivLu().solve(residual);
}

/// Size of a change (dx, dT / T) of an orbit, relative.
double size_of_change(const Eigen::VectorXd& change, const CycleStart& at)
{
  const Eigen::Index n = at.x.size();
  return change.head(n).norm() / at.x.norm() + std::abs(change[n]);
}

CycleStart moved(const CycleStart& at, const Eigen::VectorXd& change)
{
  const Eigen::Index n = at.x.size();
  return {at.x + change.head(n), at.period * (1.0 + change[n])};
}

/// An orbit without its multipliers.
struct ClosedOrbit {
  CycleStart at;
  int n_newton_steps;
};

/// Newton's method at the first tolerance of the integration.
std::optional<ClosedOrbit> shoot(AutonomousMotion& motion, CycleStart at)
{
  constexpr double tolerance = first_tolerance;
  Flow now{};
  bool renew = true;
  double before = 1.0;
  for (int i = 1; i <= orbit_newton_steps_max; ++i) {
    if (renew)
      now = flow_or_nowhere(motion, at, tolerance, rough);
    else
      now.end = end_of(motion, at, tolerance);
    if (!now.end.allFinite() || !now.derivative.allFinite()) return std::nullopt;
    const Eigen::VectorXd change = newton_step(motion, at, now);
    const double size = size_of_change(change, at);
    if (!std::isfinite(size)) return std::nullopt;
    const double damping = std::min(1.0, largest_change_of_orbit / size);
    at = moved(at, damping * change);
    if (!(at.period > 0.0)) return std::nullopt;
    if (size < nearly_converged) return ClosedOrbit{at, i};
    renew = damping < 1.0 || size > (renew ? 1e-2 : orbit_worn_out * before);
    before = size;
  }
  return std::nullopt;
}

FloquetMultipliers multipliers_of(AutonomousMotion& motion, const CycleStart& at, const Flow& flow)
{
  return floquet_multipliers(flow.derivative, motion.rate_at(at.x), motion.rate_at(flow.end));
}

/// A step with the fine derivative from an orbit that is nearly closed, of which the returned one
/// has the multipliers.
/// @param largest  largest change of x_0 by the step, relative
std::optional<PeriodicOrbit> after_step(AutonomousMotion& motion, const CycleStart& from,
                                        double tolerance, double largest)
{
  const Flow now = flow(motion, from, tolerance);
  if (!now.end.allFinite() || !now.derivative.allFinite()) return std::nullopt;
  // The end moves with the tolerance; with the fine derivative one step takes it back.
  const Eigen::VectorXd change = newton_step(motion, from, now);
  if (!(size_of_change(change, from) < largest)) return std::nullopt;
  return PeriodicOrbit{moved(from, change), multipliers_of(motion, from, now), 1, tolerance};
}

}  // namespace

Flow flow(AutonomousMotion& motion, const CycleStart& start, double tolerance)
{
  return flow_or_nowhere(motion, start, tolerance, fine(tolerance));
}

Eigen::VectorXd end_of(AutonomousMotion& motion, const CycleStart& start, double tolerance)
{
  const auto integrate = [&]() -> Eigen::VectorXd {
    DormandPrince orbit(motion, 0.0, start.x, control_of(motion, tolerance));
    return orbit.at(start.period);
  };
  return unless_stuck(integrate,
                      Eigen::VectorXd(Eigen::VectorXd::Constant(start.x.size(), nowhere)));
}

Eigen::MatrixXd states_over_period(AutonomousMotion& motion, const CycleStart& start, int n,
                                   double tolerance)
{
  Eigen::MatrixXd states = Eigen::MatrixXd::Constant(start.x.size(), n, nowhere);
  const auto integrate = [&] {
    DormandPrince orbit(motion, 0.0, start.x, control_of(motion, tolerance));
    for (int i = 0; i < n; ++i) states.col(i) = orbit.at(start.period * i / n);
    return true;
  };
  unless_stuck(integrate, false);
  return states;
}

std::optional<PeriodicOrbit> periodic_orbit(AutonomousMotion& motion, const CycleStart& start)
{
  const auto closed = shoot(motion, start);
  if (!closed) return std::nullopt;
  CycleStart at = closed->at;
  int n_newton_steps = closed->n_newton_steps;
  for (double tolerance = first_tolerance;; tolerance *= tolerance_factor) {
    auto orbit = after_step(motion, at, tolerance, nearly_converged);
    if (!orbit) return std::nullopt;
    orbit->n_newton_steps = ++n_newton_steps;
    if (orbit->multipliers.defect < defect_max || is_last(tolerance)) {
      return with_verdict(*orbit, [&](const CycleStart& from, double finer) {
        return after_step(motion, from, finer, settling_change);
      });
    }
    at = orbit->at;
  }
}

std::optional<PeriodicOrbit> orbit_as_it_is(AutonomousMotion& motion, const CycleStart& at)
{
  const auto orbit_at = [&motion](const CycleStart& from,
                                  double tolerance) -> std::optional<PeriodicOrbit> {
    const Flow now = flow(motion, from, tolerance);
    if (!now.end.allFinite() || !now.derivative.allFinite()) return std::nullopt;
    return PeriodicOrbit{from, multipliers_of(motion, from, now), 0, tolerance};
  };
  auto orbit = orbit_at(at, first_tolerance);
  if (orbit) orbit = with_verdict(*orbit, orbit_at);
  return orbit;
}

std::optional<CycleStart> sharper_start(AutonomousMotion& motion, const CycleStart& at)
{
  const Flow now = flow_or_nowhere(motion, at, sharp_tolerance, fine(first_tolerance));
  if (!now.end.allFinite() || !now.derivative.allFinite()) return std::nullopt;
  const Eigen::VectorXd change = newton_step(motion, at, now);
  if (!(size_of_change(change, at) < nearly_converged)) return std::nullopt;
  return moved(at, change);
}

namespace {

/// Errors of X in other directions than that of the defect, relative to it.
constexpr double other_directions = 5.0;

}  // namespace

FloquetMultipliers floquet_multipliers(const Eigen::MatrixXd& X, const Eigen::VectorXd& f_start,
                                       const Eigen::VectorXd& f_end)
{
  const Eigen::Index n = X.rows();
  const double speed = f_start.norm();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr{Eigen::MatrixXd(f_start)};
  const Eigen::MatrixXd Q = linear::columns_of_Q(qr, n);
  const Eigen::MatrixXd in_Q = Q.transpose() * X * Q;
  const Eigen::MatrixXd B = in_Q.bottomRightCorner(n - 1, n - 1);

  FloquetMultipliers multipliers{Eigen::VectorXcd(n), (X * f_start - f_end).norm() / speed, 0.0,
                                 0.0};
  multipliers.values[0] = in_Q(0, 0);
  multipliers.values.tail(n - 1) = linear::real_eigenvalues(B);
  std::sort(multipliers.values.begin() + 1, multipliers.values.end(),
            [](const auto& a, const auto& b) {
              return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
            });
  multipliers.condition = EigenvalueChange(B, multipliers.values[1]).condition();
  multipliers.error = other_directions * multipliers.defect * multipliers.condition;
  return multipliers;
}

}  // namespace chladni::squeal
