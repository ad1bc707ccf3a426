#include "squeal/stability/group_exponents.hpp"
#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace chladni::squeal {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;
using Eigen::Index;

/// Steps are halved until the growth changes by less, 1/s, or by less than this part of what the
/// equations of the group leave open.
constexpr double growth_error = 1e-8, part_of_error = 0.1;
constexpr Index n_steps_max = Index{1} << 18;
/// Halvings that do not lessen the change before there are no more.
constexpr int stuck_max = 2;
/// Error over the largest of these changes.
constexpr double chance = 4.0;
/// Of the invariant flag over one period, per angle, and how often it is passed until then.
constexpr double flag_error = 1e-13;
constexpr int n_passes_max = 8;

/// Exponents per angle, modulo i, their mean frequencies, and what the vectors that belong to them
/// fail to return to themselves by.
struct Flag {
  Eigen::VectorXcd exponent;
  Eigen::VectorXd frequency;
  double error;
};

template <int G>
using Square = Eigen::Matrix<Complex, G, G>;

template <int G>
Square<G> commutator(const Square<G>& A, const Square<G>& B)
{
  return A * B - B * A;
}

/// exp(A) by Taylor's series of A / 2^s.
template <int G>
Square<G> exponential(Square<G> A)
{
  const double norm = A.cwiseAbs().rowwise().sum().maxCoeff();
  int squarings = 0;
  for (double x = norm; x > 0.5; x *= 0.5) ++squarings;
  A *= std::ldexp(1.0, -squarings);
  Square<G> term = Square<G>::Identity(A.rows(), A.cols()), sum = term;
  for (int i = 1; i < 16; ++i) {
    term = (term * A / double(i)).eval();
    sum += term;
  }
  for (int i = 0; i < squarings; ++i) sum = (sum * sum).eval();
  return sum;
}

/// F / step less its mean diagonal, over the angle.
struct Shifted {
  AngleHarmonics c;
  Complex mean;
};

Shifted shifted(const NearGroup& group, double step)
{
  const auto g = static_cast<Index>(group.states.size());
  Shifted F{group.F / step, 0.0};
  for (Index j = 0; j < g; ++j) F.mean += F.c(j * g + j, 0) / double(g);
  for (Index j = 0; j < g; ++j) F.c(j * g + j, 0) -= F.mean;
  return F;
}

/// At M angles, by the part `offset` of their spacing further on.
AngleSamples samples_at(const AngleHarmonics& c, Index M, double offset)
{
  const Index N = c.cols();
  AngleHarmonics wide = AngleHarmonics::Zero(c.rows(), M);
  for (Index column = 0; column < N; ++column) {
    const Index k = order_of(column, N);
    if (2 * std::abs(k) >= M) continue;
    wide.col(column_of(k, M)) +=
        c.col(column) * std::polar(1.0, 2.0 * pi * double(k) * offset / double(M));
  }
  return samples_of(std::move(wide));
}

/// Steps of Magnus' series over one period: y at the end of step s is exp(Omega_s) y.
template <int G>
class Orbit {
 public:
  Orbit(const AngleHarmonics& c, Index g, Index M) : g_(g), middle_(samples_at(c, M, 0.5))
  {
    const double gauss = std::sqrt(15.0) / 10.0, h = 2.0 * pi / double(M);
    const AngleSamples first = samples_at(c, M, 0.5 - gauss), last = samples_at(c, M, 0.5 + gauss);
    const auto at = [&](const AngleSamples& f, Index s) {
      return Square<G>(Eigen::Map<const Square<G>>(f.col(s).data(), g, g));
    };
    for (Index s = 0; s < M; ++s) {
      const Square<G> F_1 = at(first, s), F_2 = at(middle_, s), F_3 = at(last, s);
      const Square<G> a_1 = h * F_2, a_2 = std::sqrt(15.0) / 3.0 * h * (F_3 - F_1),
                      a_3 = 10.0 / 3.0 * h * (F_3 - 2.0 * F_2 + F_1);
      const Square<G> C_1 = commutator<G>(a_1, a_2);
      const Square<G> C_2 = commutator<G>(a_1, 2.0 * a_3 + C_1) / -60.0;
      const Square<G> Omega =
          a_1 + a_3 / 12.0 + commutator<G>(-20.0 * a_1 - a_3 + C_1, a_2 + C_2) / 240.0;
      steps_.push_back(exponential<G>(Omega));
    }
  }

  /// The eigenvectors of the product, made orthogonal, stay so when each step is followed by a QR
  /// factorisation: the product of the R has the multipliers on its diagonal, each to its own
  /// accuracy, however far their sizes are apart.
  Flag motions() const
  {
    Square<G> product = Square<G>::Identity(g_, g_);
    for (const Square<G>& step : steps_) product = (step * product).eval();
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver{Eigen::MatrixXcd(product)};
    std::vector<Index> order(static_cast<std::size_t>(g_));
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::sort(order, [&](Index a, Index b) {
      return std::abs(solver.eigenvalues()[a]) > std::abs(solver.eigenvalues()[b]);
    });
    Square<G> Q = solver.eigenvectors()(every, order);
    orthogonalise(Q);
    Flag flag = passed(Q);
    for (int i = 0; i < n_passes_max && flag.error > flag_error; ++i) flag = passed(Q);
    return flag;
  }

 private:
  /// One period from Q, which becomes what it is at the end.
  Flag passed(Square<G>& Q) const
  {
    const Square<G> start = Q;
    const double n = double(steps_.size());
    Flag flag{Eigen::VectorXcd::Zero(g_), Eigen::VectorXd::Zero(g_), 0.0};
    for (std::size_t s = 0; s < steps_.size(); ++s) {
      const Square<G> F =
          Eigen::Map<const Square<G>>(middle_.col(static_cast<Index>(s)).data(), g_, g_);
      const Square<G> FQ = F * Q;
      for (Index i = 0; i < g_; ++i) flag.frequency[i] += Q.col(i).dot(FQ.col(i)).imag() / n;
      Q = (steps_[s] * Q).eval();
      flag.exponent += orthogonalise(Q).array().log().matrix() / (2.0 * pi);
    }
    for (Index i = 0; i < g_; ++i) {
      const Complex turn = start.col(i).dot(Q.col(i));
      flag.exponent[i] += std::log(turn) / (2.0 * pi);
      flag.error = std::max(flag.error, std::abs(std::log(std::abs(turn))) / (2.0 * pi));
    }
    return flag;
  }

  /// Q = Q' R by Gram and Schmidt; returns the diagonal of R.
  static Eigen::VectorXd orthogonalise(Square<G>& Q)
  {
    Eigen::VectorXd R(Q.cols());
    for (Index i = 0; i < Q.cols(); ++i) {
      for (Index j = 0; j < i; ++j) Q.col(i) -= Q.col(j) * Q.col(j).dot(Q.col(i));
      R[i] = Q.col(i).norm();
      Q.col(i) /= R[i];
    }
    return R;
  }

  Index g_;
  AngleSamples middle_;
  std::vector<Square<G>> steps_;
};

template <int G>
GroupExponents integrated(const NearGroup& group, double step)
{
  const auto g = static_cast<Index>(group.states.size());
  const Shifted F = shifted(group, step);
  const double turns = 2.0 * pi * samples_of(F.c).cwiseAbs().colwise().maxCoeff().maxCoeff();
  Index M = power_of_two(std::max(4 * F.c.cols(), static_cast<Index>(4.0 * turns)));
  Flag flag = Orbit<G>(F.c, g, M).motions();
  double change = std::numeric_limits<double>::infinity(), unsettled = 0.0;
  // Each half of a step errs a 64th: what does not fall is rounding, or exponents so near each
  // other that the flag of their vectors turns slowly, and no step helps. Changes that do not fall
  // are differences of two errors of one size, small by chance.
  int stuck = 0;
  const double enough = std::max(growth_error, part_of_error * group.error);
  while (change > enough && M < n_steps_max && stuck < stuck_max) {
    M *= 2;
    const Flag finer = Orbit<G>(F.c, g, M).motions();
    const double last = change;
    change = step * (finer.exponent - flag.exponent).real().cwiseAbs().maxCoeff();
    stuck = change > 0.25 * last ? stuck + 1 : 0;
    unsettled = stuck > 0 ? std::max({unsettled, change, last}) : 0.0;
    flag = finer;
  }
  GroupExponents result{Eigen::VectorXcd(g),
                        std::max({change, chance * unsettled, step * flag.error})};
  for (Index i = 0; i < g; ++i) {
    const double replica = std::round(flag.frequency[i] - flag.exponent[i].imag());
    result.lambda[i] = step * (F.mean + flag.exponent[i] + Complex(0.0, replica));
  }
  return result;
}

}  // namespace

GroupExponents group_exponents(const NearGroup& group, double step)
{
  switch (group.states.size()) {
    case 1:
      return {group.F.col(0), 0.0};
    case 2:
      return integrated<2>(group, step);
    case 3:
      return integrated<3>(group, step);
    case 4:
      return integrated<4>(group, step);
    default:
      return integrated<Eigen::Dynamic>(group, step);
  }
}

}  // namespace chladni::squeal
