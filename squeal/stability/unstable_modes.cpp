#include "squeal/stability/unstable_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/numerics.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/stability/error_budget.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

using Eigen::Index;

namespace {

/// Halvings of the distance of two samples before Newton's method starts, and at most.
constexpr int halvings_before_newton = 7;

constexpr int halvings_at_limit = 60;

/// Halvings of the distance in the search for an extremum.
constexpr int halvings_of_extremum = 20;

/// How near Newton's frequency must be to that of the motion at Newton's value, relative.
constexpr double same_frequency = 1e-6;

double frequency_distance(const ModeSample& sample, Index j, Index k)
{
  return (sample.lambda[j] - sample.lambda[k]).imag();
}

/// Where the frequencies of two stable motions are one, by linear interpolation.
std::vector<ModeSample> modes_at_crossings(const StateMatrixOf& A, const ModeSample& low,
                                           const ModeSample& high, const std::vector<Index>& which)
{
  std::vector<ModeSample> found;
  const auto is_stable = [&](Index j) { return !low.is_unstable(j) && !high.is_unstable(j); };
  for (const Index j : which) {
    for (const Index k : which) {
      if (k <= j || !is_stable(j) || !is_stable(k)) continue;
      const double a = frequency_distance(low, j, k), b = frequency_distance(high, j, k);
      // Frequencies that differ by rounding alone do not cross.
      if (a * b < 0.0 && std::abs(a - b) > 1e3 * (low.doubt[j] + low.doubt[k]))
        found.push_back(mode_sample_between(A, low, high, a / (a - b)));
    }
  }
  return found;
}

/// Two samples, without and with growth of a motion.
struct ModeBracket {
  ModeSample stable, unstable;

  double width() const { return std::abs(unstable.value - stable.value); }
  bool holds(double value) const
  {
    return std::abs(value - stable.value) <= width() && std::abs(value - unstable.value) <= width();
  }
};

/// Halved so many times, or until it holds no number between its ends.
ModeBracket halved(const StateMatrixOf& A, ModeBracket b, Index j, int times)
{
  for (int k = 0; k < times; ++k) {
    ModeSample middle = mode_sample_between(A, b.stable, b.unstable, 0.5);
    if (middle.value == b.stable.value || middle.value == b.unstable.value) break;
    (middle.is_unstable(j) ? b.unstable : b.stable) = std::move(middle);
  }
  return b;
}

StabilityPoint limit_within(const StateMatrixOf& A, const ModeBracket& wide, Index j)
{
  const ModeBracket near = halved(A, wide, j, halvings_before_newton);
  const ModeSample& at = near.unstable;
  const auto newton = hopf_point(A, at.value, at.lambda[j].imag(), at.X.col(j));
  // The doubt may hide the first growth of a slow motion: then Newton's value is below the bracket.
  if (newton && ModeBracket{wide.stable, near.unstable}.holds(newton->value)) {
    const double t = near.width() > 0.0 ? (newton->value - near.stable.value) /
                                              (near.unstable.value - near.stable.value)
                                        : 0.0;
    const ModeSample there = mode_sample_between(A, near.stable, near.unstable, t);
    const std::complex<double> i_omega(0.0, newton->omega);
    if (std::abs(there.lambda[j] - i_omega) < same_frequency * std::abs(newton->omega)) {
      return {newton->value, 0.0, std::abs(newton->omega) / (2.0 * std::numbers::pi),
              newton->n_newton_steps};
    }
  }
  StabilityPoint limit = halved(A, near, j, halvings_at_limit).unstable.point(j);
  limit.growth = 0.0;
  return limit;
}

/// Adds samples to those of `followed_modes`, in the same order of motions, so that changes of the
/// stability between two samples of equal stability are found for the motions `which`. It searches
/// maxima of the growth that may exceed zero, minima that may fall below zero, and crossings of the
/// frequencies of two stable motions.
std::vector<ModeSample> with_hidden_changes(const StateMatrixOf& A, std::vector<ModeSample> samples,
                                            const std::vector<Index>& which)
{
  if (samples.size() < 2) return samples;
  // The last intervals are halved: an extremum may be within them.
  samples.insert(samples.begin() + 1, mode_sample_between(A, samples[0], samples[1], 0.5));
  samples.insert(samples.end() - 1,
                 mode_sample_between(A, samples.end()[-2], samples.end()[-1], 0.5));
  const auto half_way = [&A](const ModeSample& a, const ModeSample& b) {
    return mode_sample_between(A, a, b, 0.5);
  };
  std::vector<ModeSample> more;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    std::ranges::move(modes_at_crossings(A, samples[i - 1], samples[i], which),
                      std::back_inserter(more));
    if (i + 1 == samples.size()) break;
    for (const Index j : which) {
      if (!may_change(samples[i - 1], samples[i], samples[i + 1], j)) continue;
      const Neighbours<ModeSample> t{samples[i - 1], samples[i], samples[i + 1]};
      if (auto sample = beyond_extremum(t, j, halvings_of_extremum, half_way))
        more.push_back(std::move(*sample));
    }
  }
  std::ranges::move(more, std::back_inserter(samples));
  std::ranges::stable_sort(samples, {}, &ModeSample::value);
  return samples;
}

/// Intervals in which motion j of the samples grows. Each limit is bisected to a narrow bracket and
/// refined by Newton's method (hopf.hpp). If that leaves the bracket or the motion, bisection
/// continues to the last digit.
std::vector<UnstableInterval> unstable_intervals(const StateMatrixOf& A,
                                                 const std::vector<ModeSample>& samples, Index j)
{
  return intervals_among(samples, j, [&](const ModeSample& a, const ModeSample& b) {
    return limit_within(A, a.is_unstable(j) ? ModeBracket{b, a} : ModeBracket{a, b}, j);
  });
}

constexpr double two_pi = 2.0 * std::numbers::pi;
/// Values that are looked at, at least.
constexpr int n_scanned = 128;

StateMatrixOf state_matrix_over(const Brake& brake, const StabilityCase& search)
{
  if (!search.over) return [&brake](double speed) { return brake.state_matrix(speed); };
  return [&brake, over = *search.over, speed = search.speed](double value) {
    return brake.with(over, value)->state_matrix(speed);
  };
}

/// So many times as fine as the values that were asked for.
int refinement(int count)
{
  return std::max(1, (n_scanned + count - 3) / (count - 1));
}

/// Motions that have a frequency of the band at one of the samples.
std::vector<Index> modes_within_band(const std::vector<ModeSample>& samples,
                                     const std::optional<FrequencyBand>& band)
{
  std::vector<Index> which;
  for (Index j = 0; j < samples.front().size(); ++j) {
    const bool within = !band || std::ranges::any_of(samples, [&](const ModeSample& sample) {
      const double f_Hz = sample.point(j).frequency_Hz;
      return f_Hz >= band->from_Hz && f_Hz <= band->to_Hz;
    });
    if (within) which.push_back(j);
  }
  return which;
}

/// Coordinates of the inertial disc that are one family of modes.
struct Coordinates {
  Index first, size;
};

std::vector<Coordinates> families_of(const InertialDisc& disc)
{
  std::vector<Coordinates> families;
  for (Index i = 0; i < disc.n_modes(); i += families.back().size)
    families.push_back({i, disc.nodal_diameters[static_cast<std::size_t>(i)] == 0 ? 1 : 2});
  return families;
}

/// Where the motion grows most, and what takes part in it: kinetic energy is |p|^2 / 2 of each
/// coordinate, the second half of an eigenvector (omega a, p).
const ModeSample& add_worst(StabilityBranch& branch, const std::vector<ModeSample>& samples,
                            Index j, const FlexibleDisc* body)
{
  const ModeSample& worst = *std::ranges::max_element(
      samples, {}, [j](const ModeSample& sample) { return sample.growth(j); });
  branch.worst = worst.point(j);
  if (!body) return worst;
  const Eigen::VectorXd p = worst.X.col(j).tail(worst.X.rows() / 2).cwiseAbs2();
  const auto families = families_of(body->inertial());
  branch.shares.resize(std::ssize(families));
  for (std::size_t i = 0; i < families.size(); ++i) {
    branch.shares[static_cast<Index>(i)] =
        p.segment(families[i].first, families[i].size).sum() / p.sum();
  }
  branch.pads = p.tail(p.size() - body->inertial().n_modes()).sum() / p.sum();
  return worst;
}

/// The works in a period of motion j, and the error of its growth; both absent without a body, and
/// where it does not oscillate.
void add_work_and_error(StabilityBranch& branch, const Brake& brake, const StabilityCase& search,
                        const ModeSample& sample, Index j)
{
  const std::complex<double> lambda = sample.lambda[j];
  if (!brake.body() || !(lambda.imag() > 0.0)) return;
  const auto there = search.over ? brake.with(*search.over, sample.value) : nullptr;
  const FlexibleDisc& body = there ? *there->body() : *brake.body();
  const double speed = there ? search.speed : sample.value;
  branch.work = period_work(body, speed, lambda, sample.X.col(j));
  branch.budget = growth_error_budget(body, speed, lambda);
}

/// Of the mode of the body that has the largest part in a coordinate of the inertial disc.
ModeFigure figure_of(const Disc& disc, const InertialDisc& inertial, Index coordinate)
{
  if (disc.figures.empty()) return {};
  Index mode = 0;
  inertial.R.col(coordinate).cwiseAbs().maxCoeff(&mode);
  return disc.figures[static_cast<std::size_t>(mode)];
}

/// Without its branches.
StabilityTable empty_table(const Brake& brake, const StabilityCase& search)
{
  StabilityTable table{.parameter = search.over ? key_of(*search.over) : "speed",
                       .speed = search.over ? std::optional(search.speed) : std::nullopt,
                       .band = search.band,
                       .values = Eigen::VectorXd::LinSpaced(search.count, search.from, search.to),
                       .families = {},
                       .branches = {},
                       .method = "eigenvalues"};
  if (const FlexibleDisc* body = brake.body()) {
    const InertialDisc& disc = body->inertial();
    for (const Coordinates& family : families_of(disc)) {
      const ModeFigure figure = figure_of(body->disc(), disc, family.first);
      table.families.push_back({disc.nodal_diameters[static_cast<std::size_t>(family.first)],
                                disc.omega[family.first] / two_pi, figure.circles,
                                figure.in_plane});
    }
  }
  return table;
}

}  // namespace

StabilityCase stability_case(const StudyOptions& options)
{
  const SpeedRange& speeds = options.speeds;
  return options.stability.value_or(StabilityCase{
      .over = {}, .from = speeds.from, .to = speeds.to, .count = speeds.count, .band = {}});
}

void require_band_of(const Disc& disc, const StabilityCase& search)
{
  if (!search.band) return;
  const double range = disc.compliance.empty()
                           ? disc.omega.maxCoeff()
                           : std::min(disc.omega.maxCoeff(), disc.compliance.lowest_omega);
  if (search.band->to_Hz * two_pi <= range) return;
  throw Error(fmt::format(
      "[squeal] stability.band_Hz = [{:.6g}, {:.6g}] goes beyond the modes of the body, "
      "{:.6g} to {:.6g} Hz; end it there, or take a body with more modes",
      search.band->from_Hz, search.band->to_Hz, disc.omega.minCoeff() / two_pi, range / two_pi));
}

StabilityTable unstable_modes(const Brake& brake, const StabilityCase& search,
                              const TurningTableOf& by_hill)
{
  if (const FlexibleDisc* body = brake.body()) {
    require_band_of(body->disc(), search);
    if (!brake.is_autonomous()) return by_hill(*body, search);
  }
  StabilityTable table = empty_table(brake, search);
  const StateMatrixOf A = state_matrix_over(brake, search);
  const int finer = refinement(search.count);
  std::vector<ModeSample> samples = followed_modes(
      A, {.from = search.from, .to = search.to, .count = finer * (search.count - 1) + 1});
  const std::vector<Index> which = modes_within_band(samples, search.band);
  for (const Index j : which) {
    StabilityBranch branch{};
    branch.lambda.resize(search.count);
    for (Index i = 0; i < search.count; ++i)
      branch.lambda[i] = samples[static_cast<std::size_t>(finer * i)].lambda[j];
    table.branches.push_back(std::move(branch));
  }
  samples = with_hidden_changes(A, std::move(samples), which);
  for (std::size_t k = 0; k < which.size(); ++k) {
    table.branches[k].unstable = unstable_intervals(A, samples, which[k]);
    StabilityBranch& branch = table.branches[k];
    const ModeSample& worst = add_worst(branch, samples, which[k], brake.body());
    if (branch.is_unstable()) add_work_and_error(branch, brake, search, worst, which[k]);
  }
  std::ranges::stable_sort(table.branches, {},
                           [](const StabilityBranch& b) { return b.worst.frequency_Hz; });
  return table;
}

namespace {

/// Condition of an eigenvalue beyond which it is no longer asked for; see stability_samples.cpp.
constexpr double most_condition = 1e6;
/// MAC from which two shapes are one motion without further doubt.
constexpr double sure_likeness = 0.5;
/// How much farther than the chosen eigenvalue all others are, for it to be alone.
constexpr double alone = 4.0;
/// Halvings of the distance of two samples, where shapes change fast.
constexpr int halvings_of_step = 4;
/// Deviation from the extrapolation, relative to lambda, that says little about two motions.
constexpr double small_deviation = 1e-3;

/// The places of one eigenvalue of each mode, as oscillating_eigenvalues chooses and orders them.
std::vector<Index> oscillating(const Eigen::VectorXcd& lambda)
{
  std::vector<Index> at(static_cast<std::size_t>(lambda.size()));
  std::iota(at.begin(), at.end(), Index{0});
  std::ranges::sort(at, [&](Index i, Index j) {
    return lambda[i].imag() != lambda[j].imag() ? lambda[i].imag() > lambda[j].imag()
                                                : lambda[i].real() > lambda[j].real();
  });
  at.resize(at.size() / 2);
  return at;
}

/// Right eigenvectors of norm 1 and left ones with y_i^H x_j = delta_ij.
struct Vectors {
  Eigen::MatrixXcd X, Y;
};

/// Those of some eigenvalues. A pair x, conj(x) of the real matrix is the columns Re x, Im x of R;
/// with the rows a and b of R^-1 there, y^H = (a - i b) / 2: all in real numbers.
Vectors eigenvectors_of(const Eigen::EigenSolver<Eigen::MatrixXd>& solver,
                        const std::vector<Index>& at)
{
  const Eigen::VectorXcd& lambda = solver.eigenvalues();
  Eigen::MatrixXd R = solver.pseudoEigenvectors();
  for (Index j = 0; j < R.cols(); ++j) {
    const bool is_pair = lambda[j].imag() != 0.0 && j + 1 < R.cols();
    R.middleCols(j, is_pair ? 2 : 1) /= R.middleCols(j, is_pair ? 2 : 1).norm();
    if (is_pair) ++j;
  }
  const Eigen::MatrixXd S = R.inverse().transpose();
  Vectors of{Eigen::MatrixXcd(R.rows(), std::ssize(at)),
             Eigen::MatrixXcd(R.rows(), std::ssize(at))};
  for (Index k = 0; k < std::ssize(at); ++k) {
    const Index j = at[static_cast<std::size_t>(k)];
    const double sign = lambda[j].imag() < 0.0 ? -1.0 : 1.0;
    const Index first = sign < 0.0 ? j - 1 : j;
    if (lambda[j].imag() == 0.0) {
      of.X.col(k) = R.col(j).cast<std::complex<double>>();
      of.Y.col(k) = S.col(j).cast<std::complex<double>>();
      continue;
    }
    const std::complex<double> i(0.0, sign);
    of.X.col(k) = R.col(first) + i * R.col(first + 1);
    of.Y.col(k) = 0.5 * (S.col(first) + i * S.col(first + 1));
  }
  return of;
}

ModeSample in_order(const ModeSample& sample, const std::vector<Index>& order)
{
  return {sample.value, sample.lambda(order), sample.X(every, order), sample.Y(every, order),
          sample.doubt(order)};
}

/// The motions of a sample in the order of another one.
struct Matching {
  ModeSample sample;
  bool sure;  ///< that each motion has been told from the others
};

/// The pairs that are most alike, by both shape and eigenvalue, are found first.
Matching matching(const ModeSample& before, const Eigen::VectorXcd& expected, const ModeSample& now)
{
  const Index n = now.size();
  const Eigen::MatrixXd likeness =
      (before.X.adjoint() * now.X).cwiseAbs().cwiseProduct((before.Y.adjoint() * now.Y).cwiseAbs());
  Eigen::MatrixXd distance(n, n), cost(n, n);
  for (Index i = 0; i < n; ++i) {
    distance.row(i) = (now.lambda.array() - expected[i]).abs().transpose();
    const double usual =
        std::abs(expected[i] - before.lambda[i]) + small_deviation * std::abs(expected[i]);
    cost.row(i) = 1.0 - likeness.row(i).array() +
                  distance.row(i).array() / (distance.row(i).array() + usual + 1e-300);
  }
  std::vector<Index> order(static_cast<std::size_t>(n));
  bool sure = true;
  for (Index k = 0; k < n; ++k) {
    Index i = 0, j = 0;
    cost.minCoeff(&i, &j);
    order[static_cast<std::size_t>(i)] = j;
    const bool is_alone = (distance.row(i).array() <= alone * distance(i, j)).count() == 1;
    sure = sure && (likeness(i, j) >= sure_likeness || is_alone);
    cost.row(i).setConstant(std::numeric_limits<double>::infinity());
    cost.col(j).setConstant(std::numeric_limits<double>::infinity());
  }
  return {in_order(now, order), sure};
}

/// A motion as it was last seen, and how fast its eigenvalues change with the parameter.
struct Last {
  const ModeSample& sample;
  Eigen::VectorXcd slope;

  Eigen::VectorXcd expected(double value) const
  {
    return sample.lambda + slope * (value - sample.value);
  }
};

Eigen::VectorXcd slope_of(const ModeSample& low, const ModeSample& high)
{
  return (high.lambda - low.lambda) / (high.value - low.value);
}

/// `now` in the order of the last sample, through values between them where need be.
ModeSample continued(const StateMatrixOf& A, const Last& last, const ModeSample& now, int halvings)
{
  Matching match = matching(last.sample, last.expected(now.value), now);
  if (match.sure || halvings == 0) return std::move(match.sample);
  const ModeSample middle =
      continued(A, last, mode_sample(A, std::midpoint(last.sample.value, now.value)), halvings - 1);
  return continued(A, {middle, slope_of(last.sample, middle)}, now, halvings - 1);
}

}  // namespace

StabilityPoint ModeSample::point(Index j) const
{
  return {value, growth(j), std::abs(lambda[j].imag()) / (2.0 * std::numbers::pi)};
}

ModeSample mode_sample(const StateMatrixOf& A, double value)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A(value));
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const std::vector<Index> at = oscillating(solver.eigenvalues());
  const Vectors vectors = eigenvectors_of(solver, at);
  ModeSample sample{value, solver.eigenvalues()(at), vectors.X, vectors.Y, {}};
  sample.doubt.resize(sample.size());
  const double zero = rounding_of(solver.eigenvalues());
  for (Index j = 0; j < sample.size(); ++j) {
    const double condition = sample.Y.col(j).norm();
    const bool known = std::isfinite(condition) && condition < most_condition;
    sample.doubt[j] = zero * (known ? condition : most_condition);
    // Two eigenvectors that are the same to the last digit have no left ones.
    if (std::isfinite(condition))
      sample.Y.col(j) /= condition;
    else
      sample.Y.col(j).setZero();
  }
  return sample;
}

std::vector<ModeSample> followed_modes(const StateMatrixOf& A, const SearchRange& range)
{
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to);
  std::vector<ModeSample> samples(static_cast<std::size_t>(range.count));
  for_each_index(range.count,
                 [&](int i) { samples[static_cast<std::size_t>(i)] = mode_sample(A, values[i]); });
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const ModeSample& last = samples[i - 1];
    const Eigen::VectorXcd slope = i > 1 ? slope_of(samples[i - 2], last)
                                         : Eigen::VectorXcd(Eigen::VectorXcd::Zero(last.size()));
    samples[i] = continued(A, {last, slope}, samples[i], halvings_of_step);
  }
  return samples;
}

ModeSample mode_sample_between(const StateMatrixOf& A, const ModeSample& low,
                               const ModeSample& high, double t)
{
  const ModeSample& near = t <= 0.5 ? low : high;
  const double value = low.value + t * (high.value - low.value);
  return continued(A, {near, slope_of(low, high)}, mode_sample(A, value), 1);
}

namespace {

/// Of a period: what is linear in the motion cancels, what is quadratic has two waves.
constexpr int n_phases = 8;
/// Energy of the first motion that is tried, J, and the factor from one to the next.
constexpr double first_energy = 1e-8;
constexpr double smaller = 1e-2;
constexpr int n_energies = 8;
/// Change of the works, relative, from which on they are those of the linear motion.
constexpr double linear = 1e-6;

double size_of_work(const PeriodWork& work)
{
  return std::abs(work.friction) + std::abs(work.normal) + std::abs(work.damping);
}

/// Powers relative to the energy, both means over the phases, times a period.
PeriodWork work_at(SlidingDisc& motion, const Eigen::VectorXcd& u, double period)
{
  PeriodWork work{};
  double energy = 0.0;
  for (int i = 0; i < n_phases; ++i) {
    const Eigen::VectorXd x = (u * std::polar(1.0, two_pi * i / n_phases)).real();
    const SlidingDisc::Power power = motion.sample(x).power;
    work.friction += power.friction.sum();
    work.normal += power.normal.sum();
    work.damping += power.damping;
    energy += 0.5 * x.squaredNorm();
  }
  const double scale = period / energy;
  return {scale * work.friction, scale * work.normal, scale * work.damping};
}

}  // namespace

PeriodWork period_work(const FlexibleDisc& brake, double speed, std::complex<double> lambda,
                       const Eigen::VectorXcd& u)
{
  SlidingDisc motion(brake.inertial(), brake.options(), speed);
  const double period = two_pi / lambda.imag();
  Eigen::VectorXcd v = u * (2.0 * std::sqrt(first_energy) / u.norm());
  PeriodWork work = work_at(motion, v, period);
  for (int i = 1; i < n_energies; ++i) {
    v *= std::sqrt(smaller);
    const PeriodWork now = work_at(motion, v, period);
    const double change = size_of_work(
        {now.friction - work.friction, now.normal - work.normal, now.damping - work.damping});
    work = now;
    if (change < linear * size_of_work(now)) break;
  }
  return work;
}

}  // namespace chladni::squeal
