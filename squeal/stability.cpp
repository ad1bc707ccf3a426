#include "squeal/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "common/error.hpp"
#include "mbs_export/dense_solvers.hpp"
#include "squeal/hopf.hpp"
#include "squeal/pad_system.hpp"
#include "squeal/root.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

/// One eigenvalue for each mode, largest Im first: of an oscillating pair the one with Im > 0, of
/// an overdamped pair the less damped one.
Eigen::VectorXcd oscillating_eigenvalues(const Eigen::MatrixXd& A)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, /*computeEigenvectors=*/false);
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const Eigen::VectorXcd& lambda = solver.eigenvalues();
  std::vector<Complex> sorted(lambda.begin(), lambda.end());
  std::sort(sorted.begin(), sorted.end(), [](const Complex& x, const Complex& y) {
    return x.imag() != y.imag() ? x.imag() > y.imag() : x.real() > y.real();
  });
  return Eigen::Map<const Eigen::VectorXcd>(sorted.data(), lambda.size() / 2);
}

/// The values in the order of `expected`: closest pairs of both first.
Eigen::VectorXcd matched(const Eigen::VectorXcd& values, const Eigen::VectorXcd& expected)
{
  Eigen::MatrixXd distance(values.size(), values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
    distance.row(i) = (expected.array() - values[i]).abs().transpose();
  Eigen::VectorXcd ordered(values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    Eigen::Index i = 0, j = 0;
    distance.minCoeff(&i, &j);
    ordered[j] = values[i];
    distance.row(i).setConstant(std::numeric_limits<double>::infinity());
    distance.col(j).setConstant(std::numeric_limits<double>::infinity());
  }
  return ordered;
}

Eigen::VectorXd speeds_of(const SpeedRange& range, int count)
{
  return Eigen::VectorXd::LinSpaced(count, range.from, range.to);
}

/// Largest real part that rounding can make of a zero, relative to the eigenvalue.
constexpr double rounding = 1e-12;
/// The same at a point that Newton's method has found to 1e-11.
constexpr double rounding_of_newton = 1e-11;

/// The eigenvalue at `high` that has crossed since `low`, followed back by Newton's method on the
/// bordered system; by bracketing where that leads elsewhere, as it may where two of them cross.
CriticalSpeed crossing_between(const StateMatrixAt& A, double low, double high)
{
  const auto worst = [&](double speed) { return least_stable_eigenvalue(A(speed)); };
  const EigenPair unstable = least_stable_pair(A(high));
  const auto point = hopf_point(A, high, unstable.lambda.imag(), unstable.u);
  if (point && point->value >= low && point->value <= high) {
    const Complex there = worst(point->value);
    // No other one is unstable there.
    if (there.real() <= rounding_of_newton * std::abs(there))
      return {point->value, point->omega / (2.0 * std::numbers::pi), point->n_newton_steps};
  }
  const double critical = root([&](double x) { return worst(x).real(); }, low, high);
  return {critical, worst(critical).imag() / (2.0 * std::numbers::pi), 0};
}

}  // namespace

Eigen::MatrixXd state_matrix(const InertialDisc& disc, const SquealOptions& options, double speed)
{
  const PadSystem pads = pad_system(options, ring_places(disc));
  const InertialDisc brake = with_pads(disc, pads);
  const Eigen::Index n = brake.n_modes();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), C = brake.C + 2.0 * speed * brake.G;
  for (const PointPair& point : pads.points) {
    const PairShapes S =
        pair_shapes(matrix_of(shapes_at(disc, disc.rings[point.ring], point.angle)), pads, point);
    const PairDerivatives d = pair_derivatives(point.contact, speed, static_cast<int>(S.cols()));
    K -= S * d.D_a * S.transpose();
    C -= S * d.D_p * S.transpose();
  }
  const Eigen::MatrixXd omega = brake.omega.asDiagonal();
  const Eigen::MatrixXd by_omega = brake.omega.cwiseInverse().asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << -speed * brake.D, omega, -omega - K * by_omega, -speed * brake.D - C;
  return A;
}

StateMatrixAt state_matrix_at(const InertialDisc& disc, const SquealOptions& options)
{
  return [&](double speed) { return state_matrix(disc, options, speed); };
}

Complex least_stable_eigenvalue(const Eigen::MatrixXd& A)
{
  const Eigen::VectorXcd lambda = oscillating_eigenvalues(A);
  Eigen::Index worst = 0;
  lambda.real().maxCoeff(&worst);
  return lambda[worst];
}

EigenPair least_stable_pair(const Eigen::MatrixXd& A)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const Complex expected = least_stable_eigenvalue(A);
  Eigen::Index i = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&i);
  return {solver.eigenvalues()[i], solver.eigenvectors().col(i).normalized()};
}

Complex least_stable_eigenvalue(const InertialDisc& disc, const SquealOptions& options,
                                double speed)
{
  return least_stable_eigenvalue(state_matrix(disc, options, speed));
}

EigenvalueMap eigenvalues(const StateMatrixAt& A, const SpeedRange& range)
{
  const Eigen::VectorXd speeds = speeds_of(range, range.count);
  Eigen::MatrixXcd lambda;
  for (Eigen::Index i = 0; i < speeds.size(); ++i) {
    const Eigen::VectorXcd now = oscillating_eigenvalues(A(speeds[i]));
    if (i == 0) {
      lambda.resize(speeds.size(), now.size());
      lambda.row(i) = now.reverse().transpose();
      continue;
    }
    const Eigen::VectorXcd before = lambda.row(std::max<Eigen::Index>(i - 2, 0)).transpose();
    const Eigen::VectorXcd last = lambda.row(i - 1).transpose();
    lambda.row(i) = matched(now, 2.0 * last - before).transpose();
  }
  return {speeds, lambda};
}

EigenvalueMap eigenvalues(const InertialDisc& disc, const SquealOptions& options)
{
  return eigenvalues(state_matrix_at(disc, options), options.speeds);
}

std::optional<CriticalSpeed> critical_speed(const StateMatrixAt& A, const SpeedRange& range)
{
  const Eigen::VectorXd speeds = speeds_of(range, std::max(128, range.count));
  std::optional<double> last_stable;
  for (const double speed : speeds) {
    const Complex now = least_stable_eigenvalue(A(speed));
    const bool decided = std::abs(now.real()) > rounding * std::abs(now);
    if (decided && now.real() < 0.0) last_stable = speed;
    if (!decided || now.real() < 0.0 || !last_stable) continue;
    return crossing_between(A, *last_stable, speed);
  }
  return std::nullopt;
}

std::optional<CriticalSpeed> critical_speed(const InertialDisc& disc, const SquealOptions& options)
{
  return critical_speed(state_matrix_at(disc, options), options.speeds);
}

}  // namespace chladni::squeal
