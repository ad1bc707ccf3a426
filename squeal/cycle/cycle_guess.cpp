#include "squeal/cycle/cycle_guess.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

/// Amplitudes that are looked at, relative to the displacement at which a pad loses its force, each
/// twice the one before.
constexpr double amplitude_min = 0.1;
constexpr int n_amplitudes = 14;
/// Samples of the forces in a period, and halvings of the interval in which growth ends.
constexpr int n_samples = 16;
constexpr int n_halvings = 3;
/// What is tried when no averaged growth ends, in the same measure.
constexpr double other_amplitudes[] = {2.0, 4.0, 1.0, 8.0, 16.0, 0.5, 0.25, 0.1};
/// Of an eigenvector, in the same measure: it moves the pad in proportion to itself.
constexpr double small = 1e-5;

/// Displacement of the first upper pad for each unit of v, m.
Complex pad_displacement(AutonomousMotion& motion, const Eigen::VectorXcd& v, double compression)
{
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(v.size());
  const double z_0 = motion.first_contact(rest).upper.z;
  const auto moved = [&](const Eigen::VectorXd& x, double scale) {
    return (motion.first_contact(scale * x).upper.z - z_0) / scale;
  };
  const double first = std::abs(moved(v.real(), 1e-6)) + std::abs(moved(v.imag(), 1e-6));
  const double scale = small * compression / first;
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
  for (int j = 0; j < n_samples; ++j) {
    const Complex wave = std::polar(1.0, 2.0 * pi * j / n_samples);
    const Eigen::VectorXd x = amplitude * (unstable.v * wave).real();
    sum += std::conj(wave) * unstable.y.cwiseProduct(motion.rate_at(x)).sum();
  }
  return (2.0 / n_samples / amplitude) * sum;
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
