#include "squeal/stability/turning_modes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;
using Eigen::Index;

/// Of the lower half of A at N angles of a rotation.
AngleHarmonics lower_half(TurningBrake& brake, Index N)
{
  AngleSamples samples;
  for (Index s = 0; s < N; ++s) {
    const Eigen::MatrixXd A = brake.at(2.0 * pi * double(s) / double(N));
    const Index n = A.rows() / 2;
    if (s == 0) samples.resize(n * A.cols(), N);
    samples.col(s) = A.bottomRows(n).reshaped().cast<Complex>();
  }
  return harmonics_of(std::move(samples));
}

/// What the harmonics k and -k move an eigenvalue by, the most: by way of another state and back.
double effect(const TurningHarmonics& at, Index k)
{
  const Index m = at.A_0.rows();
  const Eigen::Map<const Eigen::MatrixXcd> C(at.c.col(k).data(), m / 2, m);
  const Eigen::MatrixXcd B = at.left_V * (C * at.V), B_back = at.left_V * (C.conjugate() * at.V);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(m);
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i < m; ++i) {
      const double b_2 = std::abs(B(i, j) * B_back(j, i));
      const double d = std::abs(at.lambda[i] - at.lambda[j] - Complex(0.0, double(k) * at.speed));
      const double shift = b_2 < d * d ? b_2 / d : std::sqrt(b_2);
      moved[i] += shift;
      moved[j] += shift;
    }
  return moved.maxCoeff();
}

/// A harmonic of A and its size.
struct Harmonic {
  int k;
  double norm;  ///< 1/s
};

/// By falling norms, without the last ones, whose sum is added to `left` while it is below
/// `budget`.
std::vector<Harmonic> large_harmonics(const AngleHarmonics& c, double budget, double& left)
{
  std::vector<Harmonic> all;
  for (Index k = 1; k < c.cols() / 2; ++k)
    all.push_back({static_cast<int>(k), 2.0 * c.col(k).norm()});
  std::ranges::stable_sort(all,
                           [](const Harmonic& a, const Harmonic& b) { return a.norm > b.norm; });
  while (!all.empty() && left + all.back().norm <= budget) {
    left += all.back().norm;
    all.pop_back();
  }
  return all;
}

/// What leaving out all harmonics that are no multiples of nu does, until it is above `budget`.
double effect_of_others(const TurningHarmonics& at, const std::vector<Harmonic>& all, int nu,
                        double budget)
{
  double sum = 0.0;
  for (const Harmonic& harmonic : all) {
    if (harmonic.k % nu == 0) continue;
    sum += effect(at, harmonic.k);
    if (sum > budget) break;
  }
  return sum;
}

}  // namespace

TurningHarmonics turning_harmonics(TurningBrake brake, double speed, int bound, double budget)
{
  const AngleHarmonics c = lower_half(brake, power_of_two(2 * bound + 2));
  Eigen::MatrixXd A_0 = brake.at(0.0);
  const Index m = A_0.rows(), n = m / 2;
  A_0.bottomRows(n) = c.col(0).real().reshaped(n, m);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A_0);
  const Eigen::MatrixXcd V = solver.eigenvectors();
  const Eigen::MatrixXcd V_inverse = Eigen::PartialPivLU<Eigen::MatrixXcd>(V).inverse();
  TurningHarmonics found{speed, A_0, solver.eigenvalues(), V, V_inverse.rightCols(n), c, 0, 0, 0.0};
  const std::vector<Harmonic> large = large_harmonics(c, 0.5 * budget, found.left);
  for (std::size_t i = 0; i < large.size(); ++i) {
    const int nu = std::gcd(found.nu, large[i].k);
    if (nu == found.nu) continue;
    // The greatest divisor so far leaves out all that follows and is not a multiple of it.
    if (found.nu > 0) {
      const double others = effect_of_others(found, large, found.nu, 0.5 * budget);
      if (others <= 0.5 * budget) {
        found.left += others;
        break;
      }
    }
    found.nu = nu;
  }
  for (const Harmonic& harmonic : large)
    if (harmonic.k % std::max(1, found.nu) == 0)
      found.highest = std::max(found.highest, harmonic.k);
  return found;
}

TurningModes turning_modes(const TurningHarmonics& harmonics, Index N)
{
  const Index m = harmonics.A_0.rows(), n = m / 2;
  const int nu = std::max(1, harmonics.nu), highest = harmonics.highest / nu;
  AngleHarmonics c = AngleHarmonics::Zero(n * m, N);
  for (int k = 1; k <= highest; ++k) {
    c.col(k) = harmonics.c.col(Index{k} * nu);
    c.col(N - k) = c.col(k).conjugate();
  }
  const AngleSamples change = samples_of(std::move(c));
  const Eigen::VectorXcd& lambda = harmonics.lambda;
  const Eigen::MatrixXd VP = to_real_pairs(lambda, harmonics.V.adjoint()).adjoint().real();
  const Eigen::MatrixXd left = to_real_pairs(lambda, harmonics.left_V).real();
  TurningModes modes{nu * harmonics.speed, lambda, Eigen::MatrixXd(m * m, N), highest};
  for (Index s = 0; s < N; ++s) {
    const Eigen::MatrixXd A = change.col(s).real().reshaped(n, m);
    Eigen::Map<Eigen::MatrixXd>(modes.B.col(s).data(), m, m).noalias() = left * (A * VP);
  }
  return modes;
}

Eigen::MatrixXcd from_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd r)
{
  const Complex i(0.0, 1.0);
  for (Index row = 0; row + 1 < lambda.size(); ++row) {
    if (lambda[row].imag() == 0.0) continue;
    const Eigen::RowVectorXcd a = r.row(row), b = i * r.row(row + 1);
    r.row(row) = std::sqrt(0.5) * (a + b);
    r.row(row + 1) = std::sqrt(0.5) * (a - b);
    ++row;
  }
  return r;
}

Eigen::MatrixXcd to_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd y)
{
  const Complex i(0.0, 1.0);
  for (Index row = 0; row + 1 < lambda.size(); ++row) {
    if (lambda[row].imag() == 0.0) continue;
    const Eigen::RowVectorXcd a = y.row(row), b = y.row(row + 1);
    y.row(row) = std::sqrt(0.5) * (a + b);
    y.row(row + 1) = std::sqrt(0.5) * i * (b - a);
    ++row;
  }
  return y;
}

}  // namespace chladni::squeal
