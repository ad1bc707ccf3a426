#include "squeal/stability/error_budget.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>

#include "squeal/brake/state_matrix.hpp"
#include "squeal/stability/eigenvalue_change.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index, Eigen::MatrixXd;

/// Relative; central differences of the state matrix are exact to its square.
constexpr double step = 1e-5;

/// Where the errors of W, W_r, W_t, V_r and V_t stand in ModeErrors::mesh_shapes: a radial slope is
/// a rotation about the circumferential direction.
constexpr std::array<Index, 5> rows_of_functions{2, 4, 3, 0, 1};

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

  /// By the logarithm of the frequency of a mode or a pair.
  double by_frequency(Index first, Index size) const
  {
    return by(
        [&](InertialDisc& disc, double factor) { disc.omega.segment(first, size) *= factor; });
  }

  /// By the logarithm of what the rings do in some modes.
  /// @param functions  of W, W_r, W_t, V_r, V_t
  double by_motion(Index first, Index size, std::initializer_list<std::size_t> functions) const
  {
    return by([&](InertialDisc& disc, double factor) {
      for (InertialRing& ring : disc.rings) {
        const std::vector<Eigen::VectorXd*> amplitudes = amplitudes_of(ring);
        for (const std::size_t f : functions)
          if (f < amplitudes.size()) amplitudes[f]->segment(first, size) *= factor;
      }
    });
  }

 private:
  template <class Scale>
  double by(const Scale& scale) const
  {
    const auto scaled = [&](double factor) {
      InertialDisc disc = disc_;
      scale(disc, factor);
      return state_matrix(disc, options_, speed_);
    };
    return change(scaled(1.0 + step), scaled(1.0 - step)) / (2.0 * step);
  }

  double change(const MatrixXd& to, const MatrixXd& from) const
  {
    return lambda_.of(to - from).real();
  }

  const InertialDisc& disc_;
  const SquealOptions& options_;
  double speed_;
  EigenvalueChange lambda_;
};

/// The sum over all modes and pairs of error times sensitivity, without sign; 1/s.
/// @param errors       [n_modes] relative
/// @param sensitivity  of the growth, of a mode or pair by its first coordinate and their number
double sum_over_modes(const InertialDisc& disc, const Eigen::VectorXd& errors,
                      const std::function<double(Index first, Index size)>& sensitivity)
{
  double sum = 0.0;
  Index size = 1;
  for (Index i = 0; i < errors.size(); i += size) {
    size = disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 ? 2 : 1;
    if (errors[i] > 0.0) sum += std::abs(sensitivity(i, size)) * errors[i];
  }
  return sum;
}

/// What the errors of the body's modes do to the growth, 1/s.
ErrorBudget by_errors_of_modes(const InertialDisc& disc, const GrowingMotion& growth)
{
  ErrorBudget budget;
  const ModeErrors& errors = disc.errors;
  if (std::abs(growth.lambda().imag()) > errors.range) return budget;
  const auto by_frequency = [&](Index i, Index size) { return growth.by_frequency(i, size); };
  if (errors.mesh.size() > 0) {
    double sum = sum_over_modes(disc, errors.mesh, by_frequency);
    for (std::size_t f = 0; f < rows_of_functions.size() && errors.mesh_shapes.size() > 0; ++f) {
      sum += sum_over_modes(disc, errors.mesh_shapes.row(rows_of_functions[f]),
                            [&](Index i, Index size) { return growth.by_motion(i, size, {f}); });
    }
    budget.mesh = sum;
  }
  if (errors.reduction.size() > 0)
    budget.reduction = sum_over_modes(disc, errors.reduction, by_frequency);
  if (errors.responses) {
    // A response is quadratic in the motion of its place.
    double sum = 0.0;
    for (std::size_t f = 0; f < rows_of_functions.size(); ++f)
      sum += std::abs(growth.by_motion(0, disc.n_modes(), {f}));
    budget.body = 0.5 * *errors.responses * sum;
  }
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
        stability_over_speed(state_matrix_at(*complete), brake.options().study.speeds));
    if (of_all) budget.left_out = std::abs(of_all->speed - critical.speed);
  }
  return budget;
}

}  // namespace chladni::squeal
