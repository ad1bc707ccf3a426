#include "squeal/stability/hill_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/hill.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/unstable_modes.hpp"
#include "squeal/study/study.hpp"
#include "tests/squeal/turning_discs.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Complex = std::complex<double>;

StabilityCase speeds_of_turning(double from, double to, int count)
{
  return {.over = {}, .from = from * pi, .to = to * pi, .count = count};
}

std::vector<StabilityBranch> unstable_turning_rows(const StabilityTable& table)
{
  std::vector<StabilityBranch> rows;
  std::ranges::copy_if(table.branches, std::back_inserter(rows), &StabilityBranch::is_unstable);
  return rows;
}

/// Limits to a thousandth of the distance of two values that are looked at, the rest as they are.
void expect_same(const StabilityTable& table, const StabilityTable& expected, double step)
{
  const auto rows = unstable_turning_rows(table), references = unstable_turning_rows(expected);
  ASSERT_EQ(rows.size(), references.size());
  for (std::size_t j = 0; j < rows.size(); ++j) {
    ASSERT_EQ(rows[j].unstable.size(), references[j].unstable.size()) << j;
    for (std::size_t i = 0; i < rows[j].unstable.size(); ++i) {
      const UnstableInterval &found = rows[j].unstable[i], &reference = references[j].unstable[i];
      EXPECT_NEAR(found.from.value, reference.from.value, 1e-3 * step) << j;
      EXPECT_NEAR(found.to.value, reference.to.value, 1e-3 * step) << j;
      EXPECT_NEAR(found.from.frequency_Hz, reference.from.frequency_Hz, 1e-3) << j;
    }
    EXPECT_LT((rows[j].lambda.real() - references[j].lambda.real()).cwiseAbs().maxCoeff(), 1e-6)
        << j;
  }
}

TEST(StabilityProfile, JoinsTheIntervalsOfAllMotions)
{
  const auto branch = [](std::vector<Complex> lambda, std::vector<UnstableInterval> unstable) {
    return StabilityBranch{
        .lambda = Eigen::Map<const Eigen::VectorXcd>(lambda.data(), std::ssize(lambda)),
        .unstable = std::move(unstable),
        .worst = {},
        .shares = {}};
  };
  const auto interval = [](double from, double to, double growth) {
    return UnstableInterval{
        .from = {from, 0.0, 50.0}, .to = {to, 0.0, 50.0}, .worst = {from, growth, 50.0}};
  };
  const StabilityTable table{
      .parameter = "speed",
      .speed = {},
      .band = {},
      .values = Eigen::Vector3d(1.0, 5.0, 9.0),
      .families = {},
      .branches = {branch({{-3.0, 20.0 * pi}, {-2.0, 20.0 * pi}, {4.0, -60.0 * pi}},
                          {interval(2.0, 4.0, 7.0), interval(7.0, 9.0, 4.0)}),
                   branch({{-1.0, -40.0 * pi}, {3.0, 40.0 * pi}, {-5.0, 40.0 * pi}},
                          {interval(3.0, 6.0, 8.0), interval(3.5, 5.0, 1.0)})},
      .method = "hill"};
  const StabilityProfile profile = profile_of(table);
  EXPECT_EQ(profile.method, "hill");
  EXPECT_EQ(profile.from.value, 1.0);
  EXPECT_EQ(profile.from.growth, -1.0);
  EXPECT_DOUBLE_EQ(profile.from.frequency_Hz, 20.0);
  EXPECT_EQ(profile.to.value, 9.0);
  EXPECT_EQ(profile.to.growth, 4.0);
  EXPECT_DOUBLE_EQ(profile.to.frequency_Hz, 30.0);
  ASSERT_EQ(profile.unstable.size(), 2u);
  EXPECT_EQ(profile.unstable[0].from.value, 2.0);
  EXPECT_EQ(profile.unstable[0].to.value, 6.0);
  EXPECT_EQ(profile.unstable[0].worst.growth, 8.0);
  EXPECT_EQ(profile.unstable[1].from.value, 7.0);
  EXPECT_EQ(profile.unstable[1].worst.growth, 4.0);
}

TEST(TurningTable, IsThatOfTheEigenvaluesWhereTheDiscIsAxisymmetric)
{
  const FlexibleDisc brake(disc_of({turned_by(kirchhoff_2(), 0.4), kirchhoff_3(), kirchhoff_4()}),
                           reference_options());
  const StabilityCase speeds = speeds_of_turning(1.0, 14.0, 40);
  const StabilityTable expected = unstable_modes(brake, speeds);
  ASSERT_GE(unstable_turning_rows(expected).size(), 1u);
  const StabilityTable table = turning_table(brake, speeds);
  EXPECT_EQ(table.method, "hill");
  EXPECT_EQ(expected.method, "eigenvalues");
  expect_same(table, expected, pi / 3.0);
  StabilityCase friction{.over = MapParameter::friction, .from = 0.1, .to = 1.0, .count = 20};
  friction.speed = 6.0 * pi;
  expect_same(turning_table(brake, friction), unstable_modes(brake, friction), 0.9 / 19.0);
}

TEST(TurningTable, HasTheGrowthOfARotationOfADiscWithVanes)
{
  const FlexibleDisc brake(disc_with_vanes(), reference_options());
  ASSERT_FALSE(brake.is_autonomous());
  const StabilityTable table = unstable_modes(brake, speeds_of_turning(2.0, 14.0, 4));
  ASSERT_EQ(table.values.size(), 4);
  for (Eigen::Index i = 0; i < table.values.size(); ++i) {
    double growth = -1e9;
    for (const StabilityBranch& branch : table.branches)
      growth = std::max(growth, branch.lambda[i].real());
    const double floquet = rotation_growth(brake.disc(), brake.options(), table.values[i]).growth;
    EXPECT_NEAR(growth, floquet, 1e-3 * std::abs(floquet)) << table.values[i];
  }
}

TEST(TurningTable, HasLimitsAtWhichTheGrowthIsThatOfNoOtherMethod)
{
  // Just below each limit over the speed the disc grows otherwise than just above it, by Floquet.
  const FlexibleDisc brake(mistuned_disc(), reference_options());
  const StabilityProfile profile =
      profile_of(turning_table(brake, speeds_of_turning(2.0, 14.0, 20)));
  ASSERT_FALSE(profile.unstable.empty());
  EXPECT_EQ(profile.method, "hill");
  int n_limits = 0;
  const auto growth = [&](double speed) {
    return rotation_growth(brake.disc(), brake.options(), speed).growth;
  };
  for (const UnstableInterval& interval : profile.unstable) {
    for (const auto& [at, sign] :
         {std::pair(interval.from.value, 1.0), {interval.to.value, -1.0}}) {
      if (at == profile.from.value || at == profile.to.value) continue;
      EXPECT_LT(sign * growth(0.999 * at), 0.0) << at;
      EXPECT_GT(sign * growth(1.001 * at), 0.0) << at;
      ++n_limits;
    }
  }
  EXPECT_GT(n_limits, 0);
}

TEST(TurningTable, KeepsMotionsOfTheBand)
{
  const FlexibleDisc brake(disc_with_vanes(), reference_options());
  StabilityCase speeds = speeds_of_turning(2.0, 14.0, 4);
  const std::size_t n_all = turning_table(brake, speeds).branches.size();
  EXPECT_EQ(n_all, 4u);
  speeds.band = FrequencyBand{1500.0, 2500.0};
  const StabilityTable table = turning_table(brake, speeds);
  EXPECT_EQ(table.branches.size(), 2u);
  for (const StabilityBranch& branch : table.branches)
    EXPECT_NEAR(branch.worst.frequency_Hz, 1750.0, 60.0);
}

/// Performs the analysis of this name.
void perform(std::string_view name, const Study& study, SquealResults& results)
{
  const auto steps = analysis_steps();
  std::ranges::find(steps, name, &AnalysisStep::name)->perform(study, results, {});
}

TEST(TurningTables, AreComputedOnceForTheAnalysesOfARun)
{
  const FlexibleDisc brake(disc_with_vanes(), reference_options());
  StudyOptions options = reference_options().study;
  options.speeds = {.from = 2.0 * pi, .to = 14.0 * pi, .count = 4};
  TurningTables turning;
  const Study study{brake, options, turning};
  SquealResults results;
  perform("critical-speed", study, results);
  const int n_exponents = turning.n_exponents();
  EXPECT_GT(n_exponents, 32);
  perform("stability", study, results);
  EXPECT_EQ(turning.n_exponents(), n_exponents);
  EXPECT_EQ(results.stability_table->branches.size(), 4u);
  // Another band has the same motions, other values have not.
  options.stability = speeds_of_turning(2.0, 14.0, 4);
  options.stability->band = FrequencyBand{1500.0, 1600.0};
  perform("stability", study, results);
  EXPECT_EQ(turning.n_exponents(), n_exponents);
  options.stability->band.reset();
  options.stability->to = 13.0 * pi;
  perform("stability", study, results);
  EXPECT_GT(turning.n_exponents(), n_exponents + 32);
}

TEST(TurningTable, GivesCriticalValuesAndMapsThatAreThoseOfFloquet)
{
  // A little damping, so that there is a friction below which the disc is stable.
  Disc disc = mistuned_disc();
  disc.C = 2.0 * Eigen::Matrix4d::Identity();
  const FlexibleDisc brake(disc, reference_options());
  StudyOptions options = reference_options().study;
  options.critical = {{.parameter = MapParameter::friction, .from = 0.05, .to = 1.0}};
  options.critical[0].speed = 12.0 * pi;
  options.map = MapCase{.parameter = MapParameter::friction, .from = 0.2, .to = 0.8, .count = 2};
  options.speeds = {.from = 4.0 * pi, .to = 12.0 * pi, .count = 2};
  TurningTables turning;
  const Study study{brake, options, turning};
  SquealResults results;
  perform("critical-values", study, results);
  perform("stability-map", study, results);
  const auto growth = [&](double friction, double speed) {
    return rotation_growth(disc, with_parameter(brake.options(), MapParameter::friction, friction),
                           speed)
        .growth;
  };
  ASSERT_EQ(results.critical_values.size(), 1u);
  const CriticalValue& critical = results.critical_values[0];
  ASSERT_TRUE(critical.value);
  EXPECT_EQ(critical.profile->method, "hill");
  EXPECT_LT(growth(0.999 * *critical.value, 12.0 * pi), 0.0);
  EXPECT_GT(growth(1.001 * *critical.value, 12.0 * pi), 0.0);
  const StabilityMap& map = *results.map;
  EXPECT_EQ(map.method, "hill");
  EXPECT_LT(*map.error, 1e-4);
  for (Eigen::Index i = 0; i < 2; ++i)
    for (Eigen::Index j = 0; j < 2; ++j) {
      const double floquet = growth(map.values[i], map.speeds[j]);
      EXPECT_NEAR(map.growth(i, j), floquet, 1e-3 * std::abs(floquet));
    }
}

TEST(TurningEigenvalues, AreThoseOfTheStateMatrixWhereTheDiscIsAxisymmetric)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 2.0 * pi, .to = 12.0 * pi, .count = 3};
  const Disc disc = disc_of({turned_by(kirchhoff_2(), 0.4), kirchhoff_3()});
  const TurningEigenvalues found = turning_eigenvalues(disc, options);
  EXPECT_EQ(found.mean.of, "mean matrix");
  EXPECT_EQ(found.frozen.of, "worst frozen angle");
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::VectorXcd expected =
        oscillating_eigenvalues(state_matrix(inertial_disc(disc), options, found.mean.speeds[i]));
    for (const EigenvalueMap* map : {&found.mean, &found.frozen})
      for (const Complex lambda : map->lambda.row(i))
        EXPECT_LT((expected.array() - lambda).abs().minCoeff(), 1e-8);
  }
}

TEST(TurningEigenvalues, OfTheMeanAndOfTheWorstAngleAreTheirMatrices)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 6.0 * pi, .to = 9.0 * pi, .count = 2};
  const Disc disc = disc_of({turned_by(kirchhoff_3(), 0.3, 0.0101)});
  const SquealResults results = [&] {
    StudyOptions study = options.study;
    study.analyses = {"eigenvalues"};
    return run(FlexibleDisc(disc, options), study);
  }();
  const EigenvalueMap &mean = *results.eigenvalues, &frozen = *results.frozen_eigenvalues;
  ASSERT_EQ(frozen.angles.size(), 2);
  for (Eigen::Index i = 0; i < 2; ++i) {
    TurningBrake brake(disc, nearest_pairs(disc), options, mean.speeds[i]);
    constexpr int n = 64;
    Eigen::MatrixXd A_0 = Eigen::MatrixXd::Zero(4, 4);
    for (int s = 0; s < n; ++s) A_0 += brake.at(2.0 * pi * s / n) / n;
    const Eigen::VectorXcd of_mean = A_0.eigenvalues(),
                           of_frozen = brake.at(frozen.angles[i]).eigenvalues();
    EXPECT_NEAR(mean.lambda.row(i).real().maxCoeff(), of_mean.real().maxCoeff(), 1e-8);
    EXPECT_NEAR(frozen.lambda.row(i).real().maxCoeff(), of_frozen.real().maxCoeff(), 1e-8);
    // The split pair: the mean is nearer to the turning disc than the frozen angle is.
    const double growth = Hill(disc, options).exponents(mean.speeds[i]).lambda[0].real();
    EXPECT_LT(std::abs(mean.lambda.row(i).real().maxCoeff() - growth),
              std::abs(frozen.lambda.row(i).real().maxCoeff() - growth));
  }
  const SquealResults read = returned(results);
  EXPECT_EQ(read.frozen_eigenvalues->lambda, frozen.lambda);
  EXPECT_EQ(read.frozen_eigenvalues->angles, frozen.angles);
  EXPECT_EQ(read.eigenvalues->of, mean.of);
}

/// Motions that are known at each value, at a speed of 1 rad/s with the period of a rotation.
ExponentsAt known(const std::function<Eigen::VectorXcd(double)>& lambda)
{
  return [lambda](double value) {
    const Eigen::VectorXcd at = lambda(value);
    return ExponentSample{value, 1.0, {at, 0, 1e-9, 1, 1}, Eigen::VectorXd::Zero(at.size())};
  };
}

TEST(ExponentBranches, FindAnIntervalBetweenTheirSamples)
{
  // Growth 5e-4 - (value - 0.53)^2: positive from 0.5076 to 0.5524.
  const ExponentsAt exponents = known([](double value) {
    const double d = value - 0.53;
    return Eigen::VectorXcd::Constant(1, Complex(5e-4 - d * d, 100.3));
  });
  const auto samples = followed_exponents(exponents, Eigen::VectorXd::LinSpaced(5, 0.0, 1.0));
  for (const ExponentSample& sample : samples) EXPECT_FALSE(sample.is_unstable(0));
  const auto intervals = unstable_intervals(exponents, samples, 0);
  ASSERT_EQ(intervals.size(), 1u);
  EXPECT_NEAR(intervals[0].from.value, 0.53 - std::sqrt(5e-4), 1e-4);
  EXPECT_NEAR(intervals[0].to.value, 0.53 + std::sqrt(5e-4), 1e-4);
  EXPECT_GT(intervals[0].worst.growth, 0.0);
}

TEST(ExponentBranches, FollowMotionsThroughReplicasAndOtherOrders)
{
  // Frequencies that cross each other, and whose replica jumps by the speed at 0.5; the growth
  // tells which one it is.
  const ExponentsAt exponents = known([](double value) {
    const double jump = value < 0.5 ? 0.0 : 1.0;
    Eigen::VectorXcd lambda(2);
    lambda << Complex(-1.0, 20.1 + 0.5 * value + jump), Complex(-2.0, 20.4 - 0.3 * value);
    if (value > 0.3) lambda.reverseInPlace();
    return lambda;
  });
  for (const ExponentSample& sample :
       followed_exponents(exponents, Eigen::VectorXd::LinSpaced(21, 0.0, 1.0))) {
    EXPECT_NEAR(sample.growth(0), -1.0, 1e-12) << sample.value;
    EXPECT_NEAR(sample.growth(1), -2.0, 1e-12) << sample.value;
    EXPECT_EQ(sample.turns[0], sample.value < 0.5 ? 0.0 : -1.0) << sample.value;
  }
}

}  // namespace
}  // namespace chladni::squeal
