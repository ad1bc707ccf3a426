#include "squeal/stability/hopf.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

constexpr int newton_steps_max = 30;
constexpr int n_scanned = 128;
/// Change of omega, and a hundredth of that of the value, relative, at which Newton's method has
/// converged.
constexpr double converged = 1e-13;
/// The same where it no longer falls: rounding, which in a large system is what remains.
constexpr double converged_at_rounding = 1e-10;
/// Step of the central difference of A, relative to the value: A is smooth in it, and rounding and
/// truncation both stay below 1e-9, which slows the last steps of Newton's method only.
constexpr double difference = 1e-5;

/// g and its derivatives at (value, omega).
struct Bordered {
  Complex g, g_omega, g_value;
  Eigen::VectorXcd u;
};

Bordered bordered(const StateMatrixOf& A, double value, double omega,
                  const Eigen::VectorXcd& border)
{
  const Eigen::Index n = border.size();
  const Complex i(0.0, 1.0);
  Eigen::MatrixXcd B = Eigen::MatrixXcd::Zero(n + 1, n + 1);
  B.topLeftCorner(n, n) = A(value).cast<Complex>();
  // Scaled to the size of A, for the system to be well scaled.
  const double scale = B.topLeftCorner(n, n).cwiseAbs().maxCoeff();
  B.topLeftCorner(n, n).diagonal().array() -= i * omega;
  B.col(n).head(n) = scale * border;
  B.row(n).head(n) = scale * border.adjoint();
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(B), adjoint(B.adjoint());
  const Eigen::VectorXcd unit = scale * Eigen::VectorXcd::Unit(n + 1, n);
  const Eigen::VectorXcd x = lu.solve(unit), y = adjoint.solve(unit);
  const Eigen::VectorXcd u = x.head(n), w = y.head(n);
  const double step = difference * std::abs(value);
  const Eigen::MatrixXd A_value = (A(value + step) - A(value - step)) / (2.0 * step);
  return {x[n], w.dot(i * u) / scale, -w.dot(A_value * u) / scale, u};
}

}  // namespace

std::optional<HopfPoint> hopf_point(const StateMatrixOf& A, double value, double omega,
                                    const Eigen::VectorXcd& u)
{
  Eigen::VectorXcd border = u.normalized();
  double last = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= newton_steps_max; ++k) {
    const Bordered at = bordered(A, value, omega, border);
    Eigen::Matrix2d J;
    J << at.g_omega.real(), at.g_value.real(), at.g_omega.imag(), at.g_value.imag();
    const Eigen::Vector2d change =
        -J.partialPivLu().solve(Eigen::Vector2d(at.g.real(), at.g.imag()));
    omega += change[0];
    value += change[1];
    border = at.u.normalized();
    if (!std::isfinite(omega) || !std::isfinite(value)) return std::nullopt;
    const double size = std::max(std::abs(change[0] / omega), 1e-2 * std::abs(change[1] / value));
    if (size <= converged || (size <= converged_at_rounding && size >= 0.5 * last))
      return HopfPoint{value, omega, border, k};
    last = size;
  }
  return std::nullopt;
}

CriticalValue critical_value(const Brake& brake, const CriticalCase& search)
{
  const StateMatrixOf A = [&](double value) {
    return brake.with(search.parameter, value)->state_matrix(search.speed);
  };
  CriticalValue result{
      .parameter = key_of(search.parameter),
      .speed = search.speed,
      .value = {},
      .frequency_Hz = 0.0,
      .n_newton_steps = 0,
      .profile = stability_over(A, {.from = search.from, .to = search.to, .count = n_scanned})};
  std::optional<StabilityPoint> limit = first_loss(*result.profile);
  if (!limit) limit = first_regain(*result.profile);
  if (!limit) return result;
  result.value = limit->value;
  result.frequency_Hz = limit->frequency_Hz;
  result.n_newton_steps = limit->n_newton_steps;
  return result;
}

}  // namespace chladni::squeal
