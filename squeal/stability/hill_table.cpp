#include "squeal/stability/hill_table.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "squeal/numerics.hpp"
#include "squeal/stability/hill.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

using Eigen::Index;

namespace {

/// Values that are looked at, at least.
constexpr int exponents_scanned = 32;

ExponentsAt exponents_over(const FlexibleDisc& brake, const StabilityCase& search)
{
  const auto sample = [](const Hill& hill, double value, double speed) {
    HillExponents motion = hill.followable(speed);
    const Index n = motion.lambda.size();
    return ExponentSample{value, speed, std::move(motion), Eigen::VectorXd::Zero(n)};
  };
  if (search.over)
    return [&brake, sample, over = *search.over, speed = search.speed](double value) {
      return sample(Hill(brake.disc(), with_parameter(brake.options(), over, value)), value, speed);
    };
  return [sample, hill = Hill(brake.disc(), brake.options())](double speed) {
    return sample(hill, speed, speed);
  };
}

/// So many times as fine as the values that were asked for.
int exponent_refinement(int count)
{
  return count < 2 ? 1 : std::max(1, (exponents_scanned + count - 3) / (count - 1));
}

bool is_within(const std::vector<ExponentSample>& samples, Index j,
               const std::optional<FrequencyBand>& band)
{
  return !band || std::ranges::any_of(samples, [&](const ExponentSample& sample) {
    const double f_Hz = sample.frequency_Hz(j);
    return f_Hz >= band->from_Hz && f_Hz <= band->to_Hz;
  });
}

/// Motion j without its intervals.
StabilityBranch branch_of(const std::vector<ExponentSample>& samples, Index j, int finer)
{
  StabilityBranch branch{};
  branch.lambda.resize((std::ssize(samples) - 1) / finer + 1);
  for (Index i = 0; i < branch.lambda.size(); ++i)
    branch.lambda[i] = samples[static_cast<std::size_t>(finer * i)].motion.lambda[j];
  branch.worst = std::ranges::max_element(samples, {}, [j](const ExponentSample& sample) {
                   return sample.growth(j);
                 })->point(j);
  return branch;
}

/// The least stable motion at a value of the table.
StabilityPoint least_stable(const StabilityTable& table, Index i)
{
  const auto growth = [i](const StabilityBranch& branch) { return branch.lambda[i].real(); };
  const std::complex<double> lambda =
      std::ranges::max_element(table.branches, {}, growth)->lambda[i];
  return {table.values[i], lambda.real(), std::abs(lambda.imag()) / (2.0 * std::numbers::pi)};
}

}  // namespace

TurningMotions::TurningMotions(const FlexibleDisc& brake, const StabilityCase& search)
    : brake_(brake), search_(search)
{
  exponents_ = [this, exponents = exponents_over(brake, search)](double value) {
    ++n_exponents_;
    return exponents(value);
  };
  const int finer = exponent_refinement(search.count);
  samples_ = followed_exponents(
      exponents_,
      Eigen::VectorXd::LinSpaced(finer * (search.count - 1) + 1, search.from, search.to));
  branches_.resize(static_cast<std::size_t>(samples_.front().size()));
}

bool TurningMotions::are_of(const FlexibleDisc& brake, const StabilityCase& search) const
{
  return &brake == &brake_ && search.over == search_.over && search.from == search_.from &&
         search.to == search_.to && search.count == search_.count &&
         (!search.over || search.speed == search_.speed);
}

StabilityTable TurningMotions::table(const std::optional<FrequencyBand>& band)
{
  StabilityTable table{
      .parameter = search_.over ? key_of(*search_.over) : "speed",
      .speed = search_.over ? std::optional(search_.speed) : std::nullopt,
      .band = band,
      .values = Eigen::VectorXd::LinSpaced(search_.count, search_.from, search_.to),
      .families = {},
      .branches = {},
      .method = "hill"};
  for (const ExponentSample& sample : samples_)
    table.error = std::max(table.error, sample.motion.error);
  std::vector<Index> which;
  for (Index j = 0; j < samples_.front().size(); ++j)
    if (is_within(samples_, j, band)) which.push_back(j);
  for_each_index(static_cast<int>(which.size()), [&](int k) {
    const Index j = which[static_cast<std::size_t>(k)];
    std::optional<StabilityBranch>& branch = branches_[static_cast<std::size_t>(j)];
    if (branch) return;
    StabilityBranch found = branch_of(samples_, j, exponent_refinement(search_.count));
    found.unstable = unstable_intervals(exponents_, samples_, j);
    branch = std::move(found);
  });
  for (const Index j : which)
    table.branches.push_back(branches_[static_cast<std::size_t>(j)].value());
  std::ranges::stable_sort(table.branches, {},
                           [](const StabilityBranch& b) { return b.worst.frequency_Hz; });
  return table;
}

StabilityTable TurningTables::table(const FlexibleDisc& brake, const StabilityCase& search)
{
  const auto are = [&](const TurningMotions& motions) { return motions.are_of(brake, search); };
  const auto known = std::ranges::find_if(motions_, are);
  return (known != motions_.end() ? *known : motions_.emplace_back(brake, search))
      .table(search.band);
}

int TurningTables::n_exponents() const
{
  int n = 0;
  for (const TurningMotions& motions : motions_) n += motions.n_exponents();
  return n;
}

StabilityTable turning_table(const FlexibleDisc& brake, const StabilityCase& search)
{
  return TurningMotions(brake, search).table(search.band);
}

StabilityProfile profile_of(const StabilityTable& table)
{
  StabilityProfile profile{
      least_stable(table, 0), least_stable(table, table.values.size() - 1), {}, table.method};
  std::vector<UnstableInterval> all;
  for (const StabilityBranch& branch : table.branches)
    all.insert(all.end(), branch.unstable.begin(), branch.unstable.end());
  std::ranges::stable_sort(all, {}, [](const UnstableInterval& i) { return i.from.value; });
  for (const UnstableInterval& next : all) {
    if (profile.unstable.empty() || next.from.value > profile.unstable.back().to.value) {
      profile.unstable.push_back(next);
      continue;
    }
    UnstableInterval& joined = profile.unstable.back();
    if (next.to.value > joined.to.value) joined.to = next.to;
    if (next.worst.growth > joined.worst.growth) joined.worst = next.worst;
  }
  return profile;
}

StabilityMap turning_map(const FlexibleDisc& brake, const MapCase& range, const SpeedRange& speeds)
{
  StabilityMap map = empty_map(range, speeds);
  map.method = "hill";
  Eigen::MatrixXd error(map.growth.rows(), map.growth.cols());
  for_each_index(static_cast<int>(map.growth.size()), [&](int k) {
    const Index i = k % map.growth.rows(), j = k / map.growth.rows();
    const Hill hill(brake.disc(), with_parameter(brake.options(), range.parameter, map.values[i]));
    const HillExponents at = hill.exponents(map.speeds[j], 1);
    map.growth(i, j) = at.lambda[0].real();
    map.frequency_Hz(i, j) = std::abs(at.lambda[0].imag()) / (2.0 * std::numbers::pi);
    error(i, j) = at.error;
  });
  map.error = error.maxCoeff();
  return map;
}

namespace {

using Complex = std::complex<double>;

/// Part of its distance that a change of the replica costs.
constexpr double replica_cost = 0.05;
/// Of the distance of two samples, to which a limit between them is found.
constexpr double limit_error = 1e-4;
/// Halvings of the distance of two samples in the search for an extremum.
constexpr int halvings_of_exponent = 6;
/// Of the distance of two values, for the first slopes.
constexpr double first_step = 1e-3;
/// Exponents among which that of the critical motion is, just beside its limit.
constexpr Index few_motions = 5;

/// Where the motions are expected.
struct Expected {
  Eigen::VectorXcd lambda;  ///< [n] continuous in the parameter, 1/s
  Eigen::VectorXd turns;    ///< [n] of the sample before
};

Eigen::VectorXcd continuous(const ExponentSample& sample)
{
  return sample.motion.lambda + Complex(0.0, sample.speed) * sample.turns;
}

/// From `a` at t = 0 and `b` at t = 1, with the turns of the nearer one.
Expected expected_at(const ExponentSample& a, const ExponentSample& b, double t)
{
  return {(1.0 - t) * continuous(a) + t * continuous(b), t < 0.5 ? a.turns : b.turns};
}

/// Turns that bring lambda nearest to the expected exponent: multiples of nu.
double turns_to(const ExponentSample& sample, Complex lambda, Complex expected)
{
  const double nu = std::max(1, sample.motion.nu);
  return nu * std::round((expected - lambda).imag() / (nu * sample.speed));
}

/// In the order of the expected exponents: the closest pairs are found first. A motion that does
/// not oscillate may be missing at a value; it is then where it was expected.
ExponentSample ordered(ExponentSample sample, const Expected& expected)
{
  const Eigen::VectorXcd found = sample.motion.lambda;
  const Index n = found.size(), m = expected.lambda.size();
  Eigen::MatrixXd cost(n, m);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < m; ++j) {
      const double turns = turns_to(sample, found[i], expected.lambda[j]);
      cost(i, j) = std::abs(found[i] + Complex(0.0, turns * sample.speed) - expected.lambda[j]) +
                   replica_cost * std::abs(turns - expected.turns[j]) * sample.speed;
    }
  sample.turns = expected.turns;
  const Eigen::VectorXd doubt = sample.motion.doubt;
  sample.motion.doubt = Eigen::VectorXd::Zero(m);
  sample.motion.lambda = expected.lambda - Complex(0.0, sample.speed) * expected.turns;
  for (Index k = 0; k < std::min(n, m); ++k) {
    Index i = 0, j = 0;
    cost.minCoeff(&i, &j);
    sample.turns[j] = turns_to(sample, found[i], expected.lambda[j]);
    sample.motion.lambda[j] = found[i];
    if (doubt.size() > 0) sample.motion.doubt[j] = doubt[i];
    cost.row(i).setConstant(std::numeric_limits<double>::infinity());
    cost.col(j).setConstant(std::numeric_limits<double>::infinity());
  }
  return sample;
}

ExponentSample sample_between(const ExponentsAt& exponents, const ExponentSample& a,
                              const ExponentSample& b, double t)
{
  return ordered(exponents((1.0 - t) * a.value + t * b.value), expected_at(a, b, t));
}

/// Where motion j begins to grow, or ends to.
StabilityPoint exponent_limit_between(const ExponentsAt& exponents, const ExponentSample& a,
                                      const ExponentSample& b, Index j)
{
  const ExponentSample& stable = a.is_unstable(j) ? b : a;
  const ExponentSample& unstable = a.is_unstable(j) ? a : b;
  const double zero = stable.growth(j) < 0.0 ? 0.0 : stable.motion.error;
  StabilityPoint last{};
  const auto growth = [&](double value) {
    if (value == stable.value) return stable.growth(j) - zero;
    if (value == unstable.value) return unstable.growth(j) - zero;
    last = sample_between(exponents, a, b, (value - a.value) / (b.value - a.value)).point(j);
    return last.growth - zero;
  };
  if (!(growth(stable.value) < 0.0 && growth(unstable.value) > 0.0)) return unstable.point(j);
  const double value = root(growth, stable.value, unstable.value,
                            limit_error * (b.value - a.value) / unstable.value);
  return {value, 0.0, last.frequency_Hz};
}

}  // namespace

double ExponentSample::frequency_Hz(Index j) const
{
  return std::abs(motion.lambda[j].imag()) / (2.0 * std::numbers::pi);
}

std::vector<ExponentSample> followed_exponents(const ExponentsAt& exponents,
                                               const Eigen::VectorXd& values)
{
  std::vector<ExponentSample> samples(static_cast<std::size_t>(values.size()));
  for_each_index(static_cast<int>(values.size()),
                 [&](int i) { samples[static_cast<std::size_t>(i)] = exponents(values[i]); });
  if (samples.size() == 1) return samples;
  const ExponentSample& first = samples.front();
  const Expected start{first.motion.lambda, first.turns};
  ExponentSample before = first;
  ExponentSample last = ordered(exponents(values[0] + first_step * (values[1] - values[0])), start);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double t = (samples[i].value - before.value) / (last.value - before.value);
    samples[i] = ordered(std::move(samples[i]), expected_at(before, last, t));
    before = samples[i - 1];
    last = samples[i];
  }
  return samples;
}

std::optional<CriticalSpeed> turning_critical_speed(const FlexibleDisc& brake,
                                                    const StabilityTable& table)
{
  const StabilityProfile profile = profile_of(table);
  const std::optional<StabilityPoint> lost = first_loss(profile);
  if (!lost) return std::nullopt;
  const Index n = table.values.size();
  const double step = n > 1 ? (table.values[n - 1] - table.values[0]) / double(n - 1) : 0.0;
  const auto grows = std::ranges::find_if(
      profile.unstable, [&](const UnstableInterval& one) { return one.from.value == lost->value; });
  const double width = grows != profile.unstable.end() ? grows->to.value - grows->from.value : 0.0;
  const double h = std::min(first_step * lost->value, 0.5 * width);
  const Hill hill(brake.disc(), brake.options());
  CriticalSpeed critical{lost->value, lost->frequency_Hz};
  const auto growth_at = [&](double speed, double& error) {
    const HillExponents found = hill.exponents(speed, few_motions);
    error = std::max(error, found.error);
    Index nearest = 0;
    if (found.lambda.size() == 0) return std::numeric_limits<double>::quiet_NaN();
    (found.lambda.imag().array().abs() - 2.0 * std::numbers::pi * lost->frequency_Hz)
        .abs()
        .minCoeff(&nearest);
    return found.lambda[nearest].real();
  };
  double error = table.error;
  const double below = growth_at(lost->value - h, error), above = growth_at(lost->value + h, error);
  const double slope = (above - below) / (2.0 * h);
  if (std::isfinite(slope) && slope > 0.0)
    critical.budget.integration = limit_error * step + error / slope;
  return critical;
}

std::vector<UnstableInterval> unstable_intervals(const ExponentsAt& exponents,
                                                 const std::vector<ExponentSample>& samples,
                                                 Index j)
{
  const auto half_way = [&](const ExponentSample& a, const ExponentSample& b) {
    return sample_between(exponents, a, b, 0.5);
  };
  std::vector<ExponentSample> all = samples;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const Neighbours<ExponentSample> t{samples[i - 1], samples[i], samples[i + 1]};
    if (auto other = beyond_extremum(t, j, halvings_of_exponent, half_way))
      all.push_back(std::move(*other));
  }
  std::ranges::stable_sort(all, {}, &ExponentSample::value);
  return intervals_among(all, j, [&](const ExponentSample& a, const ExponentSample& b) {
    return exponent_limit_between(exponents, a, b, j);
  });
}

}  // namespace chladni::squeal
