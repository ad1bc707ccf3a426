#include "squeal/stability/error_budget.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/state_matrix.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd;

/// Relative; central differences of the state matrix are exact to its square.
constexpr double step = 1e-5;

VectorXcd eigenvector(const MatrixXd& A, const Complex& expected)
{
  const Eigen::EigenSolver<MatrixXd> solver(A);
  Index at = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&at);
  return solver.eigenvectors().col(at);
}

/// The critical oscillation, and how its growth changes.
class CriticalGrowth {
 public:
  CriticalGrowth(const FlexibleDisc& brake, const CriticalSpeed& critical)
      : disc_(brake.inertial()), options_(brake.options()), speed_(critical.speed)
  {
    const MatrixXd A = state_matrix(disc_, options_, speed_);
    const Complex lambda(0.0, 2.0 * std::numbers::pi * critical.frequency_Hz);
    right_ = eigenvector(A, lambda);
    left_ = eigenvector(A.transpose(), lambda);
    left_ /= left_.cwiseProduct(right_).sum();
  }

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
    return by([&](InertialDisc& disc, double factor) { disc.omega.segment(first, size) *= factor; });
  }

  /// By the logarithm of all displacements of the rings.
  double by_amplitude() const
  {
    return by([](InertialDisc& disc, double factor) {
      for (InertialRing& ring : disc.rings)
        for (Eigen::VectorXd* amplitude : amplitudes_of(ring)) *amplitude *= factor;
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
    const MatrixXd difference = to - from;
    return left_.cwiseProduct(difference * right_).sum().real();
  }

  const InertialDisc& disc_;
  const SquealOptions& options_;
  double speed_;
  VectorXcd right_, left_;
};

/// What relative errors of the frequencies make of the critical speed, rad/s.
double by_frequencies(const InertialDisc& disc, const CriticalGrowth& growth,
                      const Eigen::VectorXd& errors)
{
  double sum = 0.0;
  Index size = 1;
  for (Index i = 0; i < disc.n_modes(); i += size) {
    size = disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 ? 2 : 1;
    if (errors[i] > 0.0) sum += std::abs(growth.by_frequency(i, size)) * errors[i];
  }
  return sum / std::abs(growth.by_speed());
}

}  // namespace

ErrorBudget error_budget(const FlexibleDisc& brake, const CriticalSpeed& critical)
{
  const InertialDisc& disc = brake.inertial();
  const CriticalGrowth growth(brake, critical);
  ErrorBudget budget;
  const ModeErrors& errors = disc.errors;
  if (errors.mesh.size() > 0) budget.mesh = by_frequencies(disc, growth, errors.mesh);
  if (errors.reduction.size() > 0) budget.reduction = by_frequencies(disc, growth, errors.reduction);
  if (errors.responses)
    budget.body = std::abs(growth.by_amplitude() / growth.by_speed()) * 0.5 * *errors.responses;
  if (const FlexibleDisc* complete = brake.complete(); complete && complete->is_autonomous()) {
    const auto of_all = critical_speed(
        stability_over_speed(state_matrix_at(*complete), brake.options().study.speeds));
    if (of_all) budget.left_out = std::abs(of_all->speed - critical.speed);
  }
  return budget;
}

}  // namespace chladni::squeal
