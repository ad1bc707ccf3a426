#include "squeal/stability/error_budget.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "squeal/brake/state_matrix.hpp"
#include "squeal/stability/eigenvalue_change.hpp"
#include "squeal/stability/errors_by_modes.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {
namespace {

using Eigen::MatrixXd;

/// Relative; central differences of the state matrix are exact to its square.
constexpr double step = 1e-5;

/// An oscillation, and how its growth changes.
class GrowingMotion {
 public:
  GrowingMotion(const FlexibleDisc& brake, double speed, const std::complex<double>& lambda)
      : disc_(brake.inertial()),
        options_(brake.options()),
        speed_(speed),
        lambda_(state_matrix(disc_, options_, speed_), lambda)
  {}

  std::complex<double> lambda() const { return lambda_.lambda(); }

  /// Of the growth, by the speed; 1/s for each rad/s.
  double by_speed() const
  {
    return change(state_matrix(disc_, options_, speed_ * (1.0 + step)),
                  state_matrix(disc_, options_, speed_ * (1.0 - step))) /
           (2.0 * step * speed_);
  }

  /// By the logarithm of what a change of the disc scales, [1].
  Eigen::VectorXd by(const DiscScaling& scale) const
  {
    const auto scaled = [&](double factor) {
      InertialDisc disc = disc_;
      scale(disc, factor);
      return state_matrix(disc, options_, speed_);
    };
    return Eigen::VectorXd::Constant(1,
                                     change(scaled(1.0 + step), scaled(1.0 - step)) / (2.0 * step));
  }

  /// By as much as a change of the disc is at the factor 2, without sign, 1/s.
  double change_by(const DiscScaling& scale) const
  {
    InertialDisc disc = disc_;
    scale(disc, 2.0);
    const EigenvalueChange changed(state_matrix(disc, options_, speed_), lambda());
    return std::abs(changed.lambda().real() - lambda().real());
  }

 private:
  double change(const MatrixXd& to, const MatrixXd& from) const
  {
    return lambda_.of(to - from).real();
  }

  const InertialDisc& disc_;
  const SquealOptions& options_;
  double speed_;
  EigenvalueChange lambda_;
};

ErrorBudget by_errors_of_modes(const InertialDisc& disc, const GrowingMotion& growth)
{
  const DerivativeByDisc derivative = [&](const DiscScaling& scale) { return growth.by(scale); };
  ErrorBudget budget =
      errors_by_modes(disc, std::abs(growth.lambda().imag()), 1, derivative).budget(0);
  if (!budget.mesh || disc.errors.mesh_compliances.size() == 0) return budget;
  // Softer pads are nearer to another one in frequency, and what drives them is weaker: where these
  // effects cancel in first order, the change itself is larger.
  const double first_order = errors_by_compliance(disc, 1, derivative)[0];
  const double whole = growth.change_by(finer_under_the_pads(disc));
  *budget.mesh += std::max(0.0, whole - first_order);
  return budget;
}

}  // namespace

ErrorBudget growth_error_budget(const FlexibleDisc& brake, double speed,
                                const std::complex<double>& lambda)
{
  const GrowingMotion growth(brake, speed, lambda);
  ErrorBudget budget = by_errors_of_modes(brake.inertial(), growth);
  if (const FlexibleDisc* complete = brake.complete(); complete && complete->is_autonomous()) {
    const EigenvalueChange of_all(complete->state_matrix(speed), growth.lambda());
    budget.left_out = std::abs(of_all.lambda().real() - growth.lambda().real());
  }
  return budget;
}

ErrorBudget error_budget(const FlexibleDisc& brake, const CriticalSpeed& critical)
{
  const GrowingMotion growth(brake, critical.speed,
                             {0.0, 2.0 * std::numbers::pi * critical.frequency_Hz});
  ErrorBudget budget = by_errors_of_modes(brake.inertial(), growth);
  const double slope = std::abs(growth.by_speed());
  for (auto* part : {&budget.mesh, &budget.reduction, &budget.body})
    if (*part) **part /= slope;
  if (const FlexibleDisc* complete = brake.complete(); complete && complete->is_autonomous()) {
    const auto of_all = critical_speed(
        stability_until_critical(state_matrix_at(*complete), brake.options().study.speeds));
    if (of_all) budget.left_out = std::abs(of_all->speed - critical.speed);
  }
  return budget;
}

}  // namespace chladni::squeal
