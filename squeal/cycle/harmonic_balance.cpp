#include "squeal/cycle/harmonic_balance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/eigenvalues.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

constexpr int balance_newton_steps_max = 20;
/// A derivative serves until a change is more than this part of the one before.
constexpr double balance_worn_out = 0.4;
/// Largest change of X in one step, relative.
constexpr double largest_change_of_harmonics = 0.5;

int n_harmonics_of(const HarmonicCycle& cycle)
{
  return static_cast<int>(cycle.X.cols() / 2);
}

/// [2 n_harmonics + 1 x n_samples] 1, cos(k tau_j), sin(k tau_j).
Eigen::MatrixXd waves(int n_harmonics, Eigen::Index n_samples)
{
  const Eigen::ArrayXd tau =
      Eigen::ArrayXd::LinSpaced(n_samples, 0.0, 2.0 * pi * (1.0 - 1.0 / double(n_samples)));
  Eigen::MatrixXd gamma(2 * n_harmonics + 1, n_samples);
  gamma.row(0).setOnes();
  for (int k = 1; k <= n_harmonics; ++k) {
    gamma.row(2 * k - 1) = (k * tau).cos().transpose();
    gamma.row(2 * k) = (k * tau).sin().transpose();
  }
  return gamma;
}

/// [n_samples x 2 n_harmonics + 1]: samples times this are the coefficients.
Eigen::MatrixXd projection(const Eigen::MatrixXd& gamma)
{
  Eigen::MatrixXd P = gamma.transpose() * (2.0 / double(gamma.cols()));
  P.col(0) *= 0.5;
  return P;
}

/// X D: the coefficients of dx / d(omega t).
Eigen::MatrixXd phase_derivative(const Eigen::MatrixXd& X)
{
  Eigen::MatrixXd X_tau = Eigen::MatrixXd::Zero(X.rows(), X.cols());
  for (Eigen::Index k = 1; 2 * k < X.cols(); ++k) {
    X_tau.col(2 * k - 1) = double(k) * X.col(2 * k);
    X_tau.col(2 * k) = -double(k) * X.col(2 * k - 1);
  }
  return X_tau;
}

/// The residual omega X D - F P.
/// @return [size x columns]
Eigen::MatrixXd residual_of(AutonomousMotion& motion, const HarmonicCycle& cycle,
                            const Eigen::MatrixXd& gamma)
{
  const Eigen::MatrixXd P = projection(gamma), x = cycle.X * gamma;
  Eigen::MatrixXd residual = cycle.omega * phase_derivative(cycle.X);
  for (Eigen::Index j = 0; j < gamma.cols(); ++j)
    residual.noalias() -= motion.rate_at(x.col(j)) * P.row(j);
  return residual;
}

/// Its derivative by the entries of X, column after column.
/// @return [size columns x size columns]
Eigen::MatrixXd residual_derivative(AutonomousMotion& motion, const HarmonicCycle& cycle,
                                    const Eigen::MatrixXd& gamma)
{
  const Eigen::Index n = cycle.X.rows(), m = cycle.X.cols();
  const Eigen::MatrixXd P = projection(gamma), x = cycle.X * gamma;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n * m, n * m);
  for (Eigen::Index j = 0; j < gamma.cols(); ++j) {
    motion.take_sides(0.0, x.col(j));
    const Eigen::MatrixXd J_j = motion.jacobian(x.col(j));
    for (Eigen::Index b = 0; b < m; ++b)
      for (Eigen::Index a = 0; a < m; ++a)
        J.block(a * n, b * n, n, n) -= (P(j, a) * gamma(b, j)) * J_j;
  }
  for (Eigen::Index k = 1; 2 * k < m; ++k) {
    J.block((2 * k - 1) * n, 2 * k * n, n, n).diagonal().array() += double(k) * cycle.omega;
    J.block(2 * k * n, (2 * k - 1) * n, n, n).diagonal().array() -= double(k) * cycle.omega;
  }
  return J;
}

/// The equations for (X, ln omega): the derivative by X is bordered by that by ln omega, which
/// makes omega as large as all else, and by the phase condition <X', dX> = 0.
/// @param by_X  the derivative of the residual by X
Eigen::MatrixXd bordered_by_omega(const Eigen::MatrixXd& by_X, const HarmonicCycle& cycle)
{
  const Eigen::Index N = by_X.rows();
  const Eigen::VectorXd border = cycle.omega * phase_derivative(cycle.X).reshaped();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(N + 1, N + 1);
  J.topLeftCorner(N, N) = by_X;
  J.col(N).head(N) = border;
  J.row(N).head(N) = border.transpose();
  return J;
}

/// The start with zeros in the higher harmonics.
HarmonicCycle padded(const HarmonicCycle& start, int n_harmonics)
{
  HarmonicCycle cycle{Eigen::MatrixXd::Zero(start.X.rows(), 2 * n_harmonics + 1), start.omega};
  cycle.X.leftCols(start.X.cols()) = start.X;
  return cycle;
}

}  // namespace

std::optional<HarmonicCycle> harmonic_balance(AutonomousMotion& motion, const HarmonicCycle& start,
                                              const HarmonicResolution& resolution)
{
  assert(start.X.cols() <= 2 * resolution.n_harmonics + 1);
  assert(resolution.n_samples > 2 * resolution.n_harmonics);
  const Eigen::MatrixXd gamma = waves(resolution.n_harmonics, resolution.n_samples);
  HarmonicCycle cycle = padded(start, resolution.n_harmonics);
  const Eigen::Index N = cycle.X.size();
  Eigen::MatrixXd by_X;
  double before = 0.0;  // the last change, none while the derivative is to be made
  for (int i = 0; i < balance_newton_steps_max; ++i) {
    if (before == 0.0) by_X = residual_derivative(motion, cycle, gamma);
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(N + 1);
    rhs.head(N) = -residual_of(motion, cycle, gamma).reshaped();
    const Eigen::VectorXd change = bordered_by_omega(by_X, cycle).partialPivLu().solve(rhs);
    const double size = change.head(N).norm() / cycle.X.norm() + std::abs(change[N]);
    if (!std::isfinite(size)) return std::nullopt;
    const double damping = std::min(1.0, largest_change_of_harmonics / size);
    cycle.X += damping * change.head(N).reshaped(cycle.X.rows(), cycle.X.cols());
    cycle.omega *= 1.0 + damping * change[N];
    if (size < resolution.tolerance) return cycle;
    const bool worn = damping < 1.0 || (before > 0.0 && size > balance_worn_out * before);
    before = worn ? 0.0 : size;
  }
  return std::nullopt;
}

LinearBalance::LinearBalance(AutonomousMotion& motion, HarmonicCycle at, int n_samples)
    : at_(std::move(at)),
      gamma_(waves(n_harmonics_of(at_), n_samples)),
      solver_(bordered_by_omega(residual_derivative(motion, at_, gamma_), at_))
{}

HarmonicCycle LinearBalance::change(AutonomousMotion& more, AutonomousMotion& less,
                                    double difference) const
{
  const Eigen::Index N = at_.X.size();
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(N + 1);
  const Eigen::MatrixXd residual = residual_of(more, at_, gamma_) - residual_of(less, at_, gamma_);
  rhs.head(N) = -residual.reshaped() / difference;
  const Eigen::VectorXd solved = solver_.solve(rhs);
  return {solved.head(N).reshaped(at_.X.rows(), at_.X.cols()), at_.omega * solved[N]};
}

HarmonicCycle series_of(const Eigen::MatrixXd& states, double omega, int n_harmonics)
{
  return {states * projection(waves(n_harmonics, states.cols())), omega};
}

Eigen::MatrixXd samples_of(const HarmonicCycle& cycle, int n_samples)
{
  return cycle.X * waves(n_harmonics_of(cycle), n_samples);
}

Eigen::VectorXd start_of(const HarmonicCycle& cycle)
{
  Eigen::VectorXd x = cycle.X.col(0);
  for (Eigen::Index k = 1; 2 * k < cycle.X.cols(); ++k) x += cycle.X.col(2 * k - 1);
  return x;
}

namespace {

using Complex = std::complex<double>;

/// Amplitudes that are looked at, relative to the displacement at which a pad loses its force, each
/// twice the one before.
constexpr double amplitude_min = 0.1;
constexpr int n_amplitudes = 14;
/// Samples of the forces in a period, and halvings of the interval in which growth ends.
constexpr int wave_samples = 16;
constexpr int n_halvings = 3;
/// What is tried when no averaged growth ends, in the same measure.
constexpr double other_amplitudes[] = {2.0, 4.0, 1.0, 8.0, 16.0, 0.5, 0.25, 0.1};
/// Of an eigenvector, in the same measure: it moves the pad in proportion to itself.
constexpr double small_motion = 1e-5;

/// Displacement of the first upper pad for each unit of v, m.
Complex pad_displacement(AutonomousMotion& motion, const Eigen::VectorXcd& v, double compression)
{
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(v.size());
  const double z_0 = motion.first_contact(rest).upper.z;
  const auto moved = [&](const Eigen::VectorXd& x, double scale) {
    return (motion.first_contact(scale * x).upper.z - z_0) / scale;
  };
  const double first = std::abs(moved(v.real(), 1e-6)) + std::abs(moved(v.imag(), 1e-6));
  const double scale = small_motion * compression / first;
  return {moved(v.real(), scale), moved(v.imag(), scale)};
}

/// The least stable motion: lambda, and its right and left eigenvector with y^T v = 1, of which v
/// displaces the first pad by its compression.
struct UnstableMotion {
  Complex lambda;
  Eigen::VectorXcd v, y;
};

UnstableMotion unstable_motion(AutonomousMotion& motion, const Eigen::MatrixXd& A,
                               double compression)
{
  const EigenPair right = least_stable_pair(A);
  const Eigen::EigenSolver<Eigen::MatrixXd> left(Eigen::MatrixXd(A.transpose()));
  Eigen::Index i = 0;
  (left.eigenvalues().array() - right.lambda).abs().minCoeff(&i);
  UnstableMotion result{right.lambda, moving_the_pad(motion, right.u, compression),
                        Eigen::VectorXcd::Zero(motion.size())};
  result.y.head(A.rows()) = left.eigenvectors().col(i);
  result.y /= (result.y.transpose() * result.v).value();
  return result;
}

HarmonicCycle cycle_of(const UnstableMotion& unstable, double amplitude)
{
  HarmonicCycle cycle{Eigen::MatrixXd::Zero(unstable.v.size(), 3), unstable.lambda.imag()};
  cycle.X.col(1) = amplitude * unstable.v.real();
  cycle.X.col(2) = -amplitude * unstable.v.imag();
  return cycle;
}

/// y^T F_1(s) / s: growth and frequency of a motion of the amplitude s.
Complex averaged(AutonomousMotion& motion, const UnstableMotion& unstable, double amplitude)
{
  Complex sum = 0.0;
  for (int j = 0; j < wave_samples; ++j) {
    const Complex wave = std::polar(1.0, 2.0 * pi * j / wave_samples);
    const Eigen::VectorXd x = amplitude * (unstable.v * wave).real();
    sum += std::conj(wave) * unstable.y.cwiseProduct(motion.rate_at(x)).sum();
  }
  return (2.0 / wave_samples / amplitude) * sum;
}

}  // namespace

Eigen::VectorXcd moving_the_pad(AutonomousMotion& motion, const Eigen::VectorXcd& u,
                                double displacement)
{
  Eigen::VectorXcd v = Eigen::VectorXcd::Zero(motion.size());
  v.head(u.size()) = u;
  return v * (displacement / pad_displacement(motion, v, displacement));
}

std::vector<CycleGuess> cycle_guesses(AutonomousMotion& motion, const Eigen::MatrixXd& A,
                                      double compression)
{
  const UnstableMotion unstable = unstable_motion(motion, A, compression);
  const auto grows = [&](double s) { return averaged(motion, unstable, s).real() > 0.0; };
  std::vector<CycleGuess> guesses;
  double low = amplitude_min;
  bool before = grows(low);
  for (int k = 1; k < n_amplitudes; ++k) {
    double high = 2.0 * low;
    const bool now = grows(high);
    if (before && !now) {
      double inside = low, outside = high;
      for (int i = 0; i < n_halvings; ++i) {
        const double middle = std::sqrt(inside * outside);
        (grows(middle) ? inside : outside) = middle;
      }
      const double s = std::sqrt(inside * outside);
      guesses.push_back({cycle_of(unstable, s), s, true});
      guesses.back().cycle.omega = averaged(motion, unstable, s).imag();
    }
    before = now;
    low = high;
  }
  for (const double s : other_amplitudes) guesses.push_back({cycle_of(unstable, s), s, false});
  return guesses;
}

}  // namespace chladni::squeal
