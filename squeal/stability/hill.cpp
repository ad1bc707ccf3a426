#include "squeal/stability/hill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "squeal/stability/near_groups.hpp"
#include "squeal/stability/turning_brake.hpp"

namespace chladni::squeal {

using Eigen::Index;
using std::numbers::pi;

namespace {

constexpr Eigen::Index n_samples_max = 1024;
/// Part of the tolerance that harmonics left out of the equations may take.
constexpr double left_out = 0.1;
/// Of a period, for the disc that stands; no harmonic below it repeats at these angles.
constexpr int n_frozen_angles = 24;

/// An exponent, and the doubt of an estimate.
struct OneExponent {
  std::complex<double> lambda;
  double doubt;
};

/// Of the groups, and of all of them what the sum of their growth rates is off the trace.
HillExponents exponents_of_groups(const std::vector<NearGroup>& groups, const TurningModes& modes)
{
  std::vector<OneExponent> all;
  HillExponents result{{}, 0, 0.0, 0, 0};
  double trace = modes.lambda.sum().real();
  Index n_solved = 0;
  for (const NearGroup& group : groups) {
    const GroupExponents found = group_exponents(group, modes.step);
    trace -= (group.has_mirror ? 2.0 : 1.0) * found.lambda.sum().real();
    for (const std::complex<double>& lambda : found.lambda)
      // A real one, that is its own mirror image, may have some round-off.
      if (group.has_mirror || lambda.imag() >= 0.0 || found.lambda.size() == 1)
        all.push_back({lambda, group.doubt > 0.0 ? group.doubt + found.error : 0.0});
    if (group.doubt > 0.0) continue;
    n_solved += (group.has_mirror ? 2 : 1) * found.lambda.size();
    result.error = std::max({result.error, group.error, found.error});
    result.harmonics = std::max(result.harmonics, static_cast<int>(group.highest));
    result.coupled = std::max(result.coupled, found.lambda.size());
  }
  std::ranges::sort(all, std::ranges::greater(),
                    [](const OneExponent& one) { return one.lambda.real(); });
  result.lambda.resize(std::ssize(all));
  result.doubt.resize(std::ssize(all));
  for (std::size_t i = 0; i < all.size(); ++i) {
    result.lambda[static_cast<Index>(i)] = all[i].lambda;
    result.doubt[static_cast<Index>(i)] = all[i].doubt;
  }
  if (n_solved == modes.size()) result.error = std::max(result.error, std::abs(trace));
  return result;
}

}  // namespace

Hill::Hill(const Disc& disc, const SquealOptions& options, double tolerance)
    : disc_(disc),
      options_(options),
      tolerance_(tolerance),
      coordinates_(nearest_pairs(disc)),
      bound_(2 * highest_harmonic(disc, coordinates_))
{}

TurningHarmonics Hill::harmonics(double speed) const
{
  return turning_harmonics(brake(speed), speed, bound_, left_out * tolerance_);
}

int Hill::nu(double speed) const
{
  return harmonics(speed).nu;
}

HillExponents Hill::exponents(double speed, std::optional<Index> n_least_stable) const
{
  if (!n_least_stable) return exponents_of(speed, {});
  return exponents_of(speed, GroupsAsked{.least_stable = *n_least_stable});
}

HillExponents Hill::followable(double speed) const
{
  return exponents_of(speed, GroupsAsked{.least_stable = 1, .with_estimates = true});
}

struct Hill::Solved {
  TurningHarmonics harmonics;
  TurningModes modes;
  std::vector<NearGroup> groups;
};

Hill::Solved Hill::solved(double speed, const std::optional<GroupsAsked>& asked, Index finer) const
{
  TurningHarmonics harmonics = this->harmonics(speed);
  const int nu = std::max(1, harmonics.nu);
  const Eigen::Index highest = harmonics.highest / nu;
  // The harmonics of the corrections, three eighths of the samples, hold those of the equations.
  const Index first = std::min(n_samples_max, finer * power_of_two(8 * highest / 3 + 1));
  for (Index N = first; 2 * highest < N && N <= n_samples_max; N *= 2) {
    require_room(nu * speed, harmonics.A_0.rows(), N);
    TurningModes modes = turning_modes(harmonics, N);
    std::vector<NearGroup> groups = near_groups(modes, tolerance_, asked);
    double error = 0.0;
    for (const NearGroup& group : groups)
      if (group.doubt == 0.0) error = std::max(error, group.error);
    if (error <= tolerance_) return {std::move(harmonics), std::move(modes), std::move(groups)};
  }
  throw Error(fmt::format(
      "Hill's method at {:.6g} rad/s: {} harmonics of the rotation are not enough for a "
      "growth rate to {:.1e} 1/s; ask for \"rotation-stability\" with "
      "rotation_stability = {{ method = \"floquet\" }}",
      speed, n_samples_max / 2 * nu, tolerance_));
}

HillExponents Hill::exponents_of(double speed, const std::optional<GroupsAsked>& asked) const
{
  const Solved found = solved(speed, asked);
  HillExponents result = exponents_of_groups(found.groups, found.modes);
  result.error += found.harmonics.left;
  result.nu = found.harmonics.nu;
  result.harmonics *= found.modes.highest == 0 ? 0 : std::max(1, result.nu);
  return result;
}

namespace {

/// The motion of all states that belongs to one of a group, in the eigenvectors of A_0.
/// @param of  `group_motion`
Eigen::MatrixXcd whole_motion(const NearGroup& group, const Eigen::MatrixXcd& of, Index m)
{
  const Index g = of.rows(), N = of.cols();
  const AngleSamples X = samples_of(group.X);
  Eigen::MatrixXcd y(m, N);
  for (Index s = 0; s < N; ++s)
    y.col(s) = Eigen::Map<const Eigen::MatrixXcd>(X.col(s).data(), m, g) * of.col(s);
  y(group.states, every) += of;
  return y;
}

/// A group, and one of its exponents.
struct ExponentOfGroup {
  const NearGroup* group;
  std::complex<double> lambda;
};

/// All of some groups, by descending growth.
std::vector<ExponentOfGroup> ordered_exponents(const std::vector<NearGroup>& groups, double step)
{
  std::vector<ExponentOfGroup> all;
  for (const NearGroup& group : groups)
    for (const std::complex<double>& lambda : group_exponents(group, step).lambda)
      if (group.has_mirror || lambda.imag() >= 0.0) all.push_back({&group, lambda});
  std::ranges::stable_sort(all, std::ranges::greater(),
                           [](const ExponentOfGroup& one) { return one.lambda.real(); });
  return all;
}

/// Those that may be replicas of lambda, the nearest first.
std::vector<ExponentOfGroup> replicas_of(std::complex<double> lambda,
                                         std::vector<ExponentOfGroup> all, double step)
{
  constexpr double near = 1e-2;  // 1/s: both are solved to less
  const auto distance = [&](const ExponentOfGroup& one) {
    const std::complex<double> d = one.lambda - lambda;
    return std::hypot(d.real(), d.imag() - step * std::round(d.imag() / step));
  };
  std::erase_if(all, [&](const ExponentOfGroup& one) { return distance(one) > near; });
  std::ranges::stable_sort(all, {}, distance);
  return all;
}

/// At the angles -2 pi s / N in place of 2 pi s / N.
Eigen::MatrixXcd backwards(const Eigen::MatrixXcd& z)
{
  Eigen::MatrixXcd turned = z;
  if (z.size() == 0) return turned;
  turned.rightCols(z.cols() - 1) = z.rightCols(z.cols() - 1).rowwise().reverse();
  return turned;
}

/// The part of the motions in the harmonics beyond three eighths of the samples, which lack those
/// that follow.
double unresolved(const FloquetMotions& motions)
{
  double largest = 0.0;
  for (const auto* of : {&motions.right, &motions.left})
    for (const Eigen::MatrixXcd& x : *of) {
      const AngleHarmonics c = harmonics_of(AngleSamples(x));
      double last = 0.0;
      for (Index k = 0; k < c.cols(); ++k)
        if (8 * std::abs(order_of(k, c.cols())) > 3 * c.cols()) last += c.col(k).squaredNorm();
      largest = std::max(largest, std::sqrt(last) / c.norm());
    }
  return largest;
}

}  // namespace

FloquetMotions Hill::motions(double speed, Index n, std::optional<double> omega) const
{
  // An exponent has the second power of what a motion lacks, and needs fewer samples.
  constexpr double resolved = 1e-9;
  constexpr Index about_a_limit = 5;  // where others may grow as little
  const GroupsAsked asked{.least_stable = omega ? std::max(n, about_a_limit) : n};
  for (Index finer = 1;; finer *= 2) {
    const Solved found = solved(speed, asked, finer);
    FloquetMotions motions = motions_of(found, asked, n, omega);
    const Index N = found.modes.B.cols();
    if (N == 1 || N == n_samples_max || unresolved(motions) < resolved) return motions;
  }
}

FloquetMotions Hill::motions_of(const Solved& found, const GroupsAsked& asked, Index n,
                                std::optional<double> omega) const
{
  constexpr double same_frequency = 1e-3;
  const TurningModes& modes = found.modes;
  const std::vector<NearGroup> left_groups = near_groups(adjoint_of(modes), tolerance_, asked);
  const auto of_left = ordered_exponents(left_groups, modes.step);
  const Eigen::MatrixXcd& V = found.harmonics.V;
  const Eigen::PartialPivLU<Eigen::MatrixXcd> transposed(Eigen::MatrixXcd(V.transpose()));
  FloquetMotions result{modes.step, {}, {}, {}, std::max(1, found.harmonics.nu)};
  std::vector<std::complex<double>> lambda;
  const auto whole = [&](const NearGroup& group, std::complex<double> exponent) {
    const Eigen::MatrixXcd of_group = group_motion(group, modes.step, exponent);
    return of_group.size() > 0 ? whole_motion(group, of_group, modes.size()) : of_group;
  };
  auto ordered = ordered_exponents(found.groups, modes.step);
  if (omega) {
    const auto distance = [&](const ExponentOfGroup& one) {
      return std::abs(std::abs(one.lambda.imag()) - *omega);
    };
    std::ranges::stable_sort(ordered, {}, distance);
    if (!ordered.empty() && !(distance(ordered.front()) < same_frequency * *omega)) ordered.clear();
    ordered.resize(std::min<std::size_t>(ordered.size(), 1));
  }
  for (const auto& [group, exponent] : ordered) {
    if (!lambda.empty() && (!(exponent.real() > 0.0) || std::ssize(lambda) == n)) break;
    const Eigen::MatrixXcd y = whole(*group, exponent);
    if (y.size() == 0) continue;
    for (const ExponentOfGroup& left : replicas_of(exponent, of_left, modes.step)) {
      // Of one motion l^T r is constant, of two its mean vanishes.
      constexpr double constant = 1e-3;
      const Eigen::MatrixXcd z = backwards(whole(*left.group, exponent));
      if (z.size() == 0) continue;
      const Eigen::RowVectorXcd product = y.cwiseProduct(z).colwise().sum();
      const std::complex<double> mean = product.mean();
      if (!((product.array() - mean).abs().maxCoeff() < constant * std::abs(mean))) continue;
      result.right.emplace_back(V * y);
      result.left.emplace_back(transposed.solve(z) / mean);
      lambda.push_back(exponent);
      break;
    }
  }
  result.lambda = Eigen::Map<Eigen::VectorXcd>(lambda.data(), std::ssize(lambda));
  return result;
}

FrozenDisc Hill::worst_frozen(double speed, int nu) const
{
  TurningBrake frozen = brake(speed);
  nu = std::max(1, nu);
  FrozenDisc worst{0.0, -std::numeric_limits<double>::infinity(), {}};
  for (int s = 0; s < n_frozen_angles; ++s) {
    // Each in another period: those harmonics that were left out of the motion count here.
    const double angle = 2.0 * pi * (double(s) / n_frozen_angles + s % nu) / nu;
    Eigen::MatrixXd A = frozen.at(angle);
    const double growth = linear::real_eigenvalues(A).real().maxCoeff();
    if (growth > worst.growth) worst = {angle, growth, std::move(A)};
  }
  return worst;
}

Eigen::MatrixXd Hill::mean_matrix(double speed) const
{
  // No harmonic of so many angles falls on the mean.
  TurningBrake turning = brake(speed);
  const int n_angles = bound_ + 1;
  Eigen::MatrixXd A_0 = turning.at(0.0);
  for (int s = 1; s < n_angles; ++s) A_0 += turning.at(2.0 * pi * double(s) / n_angles);
  return A_0 / double(n_angles);
}

namespace {

using Complex = std::complex<double>;

/// Steps are halved until the growth changes by less, 1/s, or by less than this part of what the
/// equations of the group leave open.
constexpr double growth_error = 1e-8, part_of_error = 0.1;
constexpr Index n_steps_max = Index{1} << 18;
/// Of the matrices of all steps of a group together: 2 gibibyte, and hours.
constexpr double entries_max = double(1 << 27);
/// Halvings that do not lessen the change before there are no more.
constexpr int stuck_refinements_max = 2;
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
    for (const Square<G>& step : steps_) {
      product = (step * product).eval();
      product /= product.cwiseAbs().maxCoeff();  // growth over a slow rotation has no limit
    }
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

  /// At N angles that motion whose exponent per angle is nearest to `exponent`, divided by its
  /// growth; what it fails to return to itself by is the relative error.
  struct Motion {
    Eigen::MatrixXcd at;
    double error;
  };
  Motion motion(Complex exponent, Index N) const
  {
    const double h = 2.0 * pi / double(steps_.size());
    const Complex by_step = std::exp(-h * exponent);
    Square<G> product = Square<G>::Identity(g_, g_);
    for (const Square<G>& step : steps_) product = (by_step * (step * product)).eval();
    Motion found{Eigen::MatrixXcd(g_, N), std::numeric_limits<double>::infinity()};
    if (!product.allFinite()) return found;
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver{Eigen::MatrixXcd(product)};
    Index nearest = 0;
    (solver.eigenvalues().array() - 1.0).abs().minCoeff(&nearest);
    Eigen::VectorXcd c = solver.eigenvectors().col(nearest);
    const Eigen::VectorXcd start = c;
    const auto every_step = std::ssize(steps_) / N;
    for (Index s = 0; s < std::ssize(steps_); ++s) {
      if (s % every_step == 0) found.at.col(s / every_step) = c;
      c = (by_step * (steps_[static_cast<std::size_t>(s)] * c)).eval();
    }
    found.error = (c - start).norm();
    return found;
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

/// Of a period, for the equations of a group of g states.
/// @throws chladni::Error where they would take hours and all memory
Index first_steps(const Shifted& F, Index g, double step)
{
  const double turns = 2.0 * pi * samples_of(F.c).cwiseAbs().colwise().maxCoeff().maxCoeff();
  const double least = std::max(4.0 * double(F.c.cols()), 4.0 * turns);
  if (least * double(g) * double(g) <= entries_max)
    return power_of_two(static_cast<Index>(least) + 1);
  throw Error(
      fmt::format("stability over a rotation: at {:.6g} rad/s (speed times the symmetry of the "
                  "disc) {} states act on each other so that none can be computed alone, and their "
                  "equations need {:.1e} steps a period; the disc is not axisymmetric: mesh it so, "
                  "or keep fewer modes in [body]",
                  step, g, least));
}

template <int G>
GroupExponents integrated(const NearGroup& group, double step)
{
  const auto g = static_cast<Index>(group.states.size());
  const Shifted F = shifted(group, step);
  Index M = first_steps(F, g, step);
  Flag flag = Orbit<G>(F.c, g, M).motions();
  double change = std::numeric_limits<double>::infinity(), unsettled = 0.0;
  // Each half of a step errs a 64th: what does not fall is rounding, or exponents so near each
  // other that the flag of their vectors turns slowly, and no step helps. Changes that do not fall
  // are differences of two errors of one size, small by chance.
  int stuck = 0;
  const double enough = std::max(growth_error, part_of_error * group.error);
  const double most = std::min(double(n_steps_max), entries_max / double(g * g));
  while (change > enough && double(M) < most && stuck < stuck_refinements_max) {
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
  if (!flag.exponent.allFinite() || !std::isfinite(result.error)) {
    throw Error(fmt::format(
        "stability over a rotation: at {:.6g} rad/s (speed times the symmetry of the disc) the "
        "exponents of {} states that act on each other are not finite; change the speed a little",
        step, g));
  }
  for (Index i = 0; i < g; ++i) {
    const double replica = std::round(flag.frequency[i] - flag.exponent[i].imag());
    result.lambda[i] = step * (F.mean + flag.exponent[i] + Complex(0.0, replica));
  }
  return result;
}

}  // namespace

Eigen::MatrixXcd group_motion(const NearGroup& group, double step, Complex lambda)
{
  constexpr double hidden = 1e-5;  // of the motion
  const auto g = static_cast<Index>(group.states.size());
  const Shifted F = shifted(group, step);
  const Index M = 2 * std::max(first_steps(F, g, step), group.F.cols());
  const auto motion =
      Orbit<Eigen::Dynamic>(F.c, g, M).motion(lambda / step - F.mean, group.F.cols());
  return motion.error < hidden ? motion.at : Eigen::MatrixXcd();
}

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
