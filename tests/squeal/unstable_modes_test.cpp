#include "squeal/stability/unstable_modes.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "common/error.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/study/study.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"
#include "tests/squeal/source_disc.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

StabilityCase over_speeds(double from, double to, int count)
{
  return {.over = {}, .from = from * pi, .to = to * pi, .count = count};
}

FlexibleDisc plate(SquealOptions options = reference_options())
{
  return {disc_of(kirchhoff_modes()), std::move(options)};
}

std::vector<StabilityBranch> unstable_ones(const StabilityTable& table)
{
  std::vector<StabilityBranch> rows;
  std::ranges::copy_if(table.branches, std::back_inserter(rows), &StabilityBranch::is_unstable);
  return rows;
}

std::string error_of_action(const std::function<void()>& action)
{
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(UnstableModes, HaveTheCriticalSpeedOfOnePair)
{
  // SQUEAL reference values; rounding as in CriticalSpeed.IsThatOfTheKirchhoffPlate.
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), reference_options());
  const StabilityTable table = unstable_modes(brake, over_speeds(1.0, 20.0, 60));
  ASSERT_EQ(table.branches.size(), 2u);
  const std::vector<StabilityBranch> rows = unstable_ones(table);
  ASSERT_EQ(rows.size(), 1u);
  ASSERT_EQ(rows[0].unstable.size(), 1u);
  const UnstableInterval& interval = rows[0].unstable[0];
  EXPECT_NEAR(interval.from.value / pi, 4.271898407362968, 1e-9);
  EXPECT_NEAR(interval.from.frequency_Hz, 1772.0954575721983, 1e-6);
  EXPECT_GT(interval.from.n_newton_steps, 0);
  EXPECT_EQ(interval.to.value, 20.0 * pi);
  EXPECT_NEAR(rows[0].worst.growth, 7.702965050554597, 1e-8);
  EXPECT_EQ(rows[0].worst.value, 20.0 * pi);
  EXPECT_NEAR(damping_ratio(rows[0].worst),
              -7.702965050554597 / std::hypot(7.702965050554597, 11257.893637671124), 1e-10);
  EXPECT_FALSE(is_always_unstable(table, rows[0]));
  EXPECT_EQ(nodal_diameters(table, rows[0]), 3);
  EXPECT_NEAR(rows[0].shares.sum() + rows[0].pads, 1.0, 1e-12);
  EXPECT_EQ(summary(table), "1 of 2 modes is unstable somewhere");
}

TEST(UnstableModes, AreAllFoundWhereSomethingSquealsAtEverySpeed)
{
  // SQUEAL 3.1, item 7: four pairs of the undamped plate are unstable at 6 pi. The largest growth
  // never changes its sign in this range, so that no critical speed exists.
  const FlexibleDisc brake = plate();
  const StabilityTable table = unstable_modes(brake, over_speeds(6.0, 7.0, 5));
  EXPECT_EQ(stability_of(stability_over_speed(state_matrix_at(brake),
                                              {.from = 6.0 * pi, .to = 7.0 * pi, .count = 5})),
            Stability::unstable);
  std::vector<int> diameters;
  std::vector<double> frequencies;
  for (const StabilityBranch& row : unstable_ones(table)) {
    if (!(row.lambda[0].real() > 1e-6)) continue;
    frequencies.push_back(row.lambda[0].imag() / (2.0 * pi));
    diameters.push_back(nodal_diameters(table, row).value());
  }
  ASSERT_EQ(frequencies.size(), 4u);
  EXPECT_EQ(diameters, (std::vector{1, 3, 4, 5}));
  for (std::size_t i = 0; i < 4; ++i)  // the reference is rounded to 1 Hz
    EXPECT_NEAR(frequencies[i], (std::array{616.0, 1775.0, 3075.0, 4706.0})[i], 1.0);
  EXPECT_EQ(table.branches.size(), 35u);
  EXPECT_TRUE(std::ranges::is_sorted(
      table.branches, {}, [](const StabilityBranch& b) { return b.worst.frequency_Hz; }));
}

TEST(UnstableModes, AreThoseThatTheEigenvaluesShow)
{
  // The defining property, at speeds that the search did not sample.
  const FlexibleDisc brake = plate();
  const StabilityTable table = unstable_modes(brake, over_speeds(1.0, 20.0, 20));
  for (const double speed : {1.234 * pi, 3.9 * pi, 4.5 * pi, 9.876 * pi, 19.3 * pi}) {
    const Eigen::VectorXcd lambda = brake.state_matrix(speed).eigenvalues();
    const auto grow = std::ranges::count_if(
        lambda, [](const auto& value) { return value.real() > 1e-6 && value.imag() > 0.0; });
    const auto listed = std::ranges::count_if(table.branches, [&](const StabilityBranch& branch) {
      return std::ranges::any_of(branch.unstable, [&](const UnstableInterval& interval) {
        return interval.from.value <= speed && speed <= interval.to.value;
      });
    });
    EXPECT_EQ(listed, grow) << speed / pi;
  }
}

TEST(UnstableModes, EndWhereTheGrowthOfTheirBranchIsZero)
{
  const FlexibleDisc brake = plate();
  int limits = 0;
  for (const StabilityBranch& row :
       unstable_ones(unstable_modes(brake, over_speeds(1.0, 20.0, 20)))) {
    for (const UnstableInterval& interval : row.unstable) {
      for (const StabilityPoint& end : {interval.from, interval.to}) {
        if (end.value == 1.0 * pi || end.value == 20.0 * pi) continue;
        const std::complex<double> i_omega(0.0, 2.0 * pi * end.frequency_Hz);
        const Eigen::VectorXcd lambda = brake.state_matrix(end.value).eigenvalues();
        EXPECT_LT((lambda.array() - i_omega).abs().minCoeff(), 1e-7) << end.value;
        ++limits;
      }
    }
  }
  EXPECT_GE(limits, 4);
}

TEST(UnstableModes, TellWhichGrowAtAllValues)
{
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), reference_options());
  const StabilityTable table = unstable_modes(brake, over_speeds(4.3, 8.0, 10));
  const std::vector<StabilityBranch> rows = unstable_ones(table);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(is_always_unstable(table, rows[0]));
}

TEST(UnstableModes, AreNoneWithoutFriction)
{
  // A conservative system: only rounding could grow.
  SquealOptions options = reference_options();
  options.friction.kinetic = 0.0;
  const StabilityTable table = unstable_modes(plate(options), over_speeds(1.0, 20.0, 5));
  EXPECT_TRUE(unstable_ones(table).empty());
  EXPECT_EQ(summary(table), "no mode is unstable at any speed of the range");
}

TEST(UnstableModes, KeepTheirShapesWhereFrequenciesCross)
{
  // As Eigenvalues.AreFollowedThroughACrossing: the forward wave of (5,0) overtakes the backward
  // wave of (2,2). 20 speeds are too few for the eigenvalues alone to tell them apart.
  SquealOptions options = reference_options();
  options.pads[0].stiffness = 6e3;
  options.pads[0].preload = 2.0;
  const FlexibleDisc brake = plate(options);
  const Eigen::Index n = brake.inertial().n_modes();
  const auto A = [&](double speed) { return brake.state_matrix(speed); };
  const std::vector<ModeSample> samples =
      followed_modes(A, {.from = 8.0 * pi, .to = 60.0 * pi, .count = 20});
  int crossings = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto shares = [&](const ModeSample& sample) -> Eigen::VectorXd {
      return sample.X.col(j).tail(n).cwiseAbs2() / sample.X.col(j).tail(n).squaredNorm();
    };
    EXPECT_LT((shares(samples.front()) - shares(samples.back())).norm(), 0.05) << j;
    for (Eigen::Index k = 0; k < j; ++k) {
      crossings += (samples.front().lambda[j] - samples.front().lambda[k]).imag() *
                       (samples.back().lambda[j] - samples.back().lambda[k]).imag() <
                   0.0;
    }
  }
  EXPECT_GT(crossings, 0);
}

TEST(UnstableModes, OfTheOscillatorBeginAtItsFlutter)
{
  // The closed form of flutter_friction holds without damping.
  Oscillator oscillator{};
  oscillator.mass = 1.0;
  oscillator.k_x = 1.0e6;
  oscillator.k_y = 0.9e6;
  oscillator.k_xy = 1e5;
  oscillator.contact_stiffness = 3e5;
  oscillator.preload = 100.0;
  oscillator.radius = 0.1;
  oscillator.friction.kinetic = 0.3;
  const double flutter = flutter_friction(oscillator);
  const StabilityTable table =
      unstable_modes(SlidingBrake(oscillator), {.over = MapParameter::friction,
                                                .from = 0.5 * flutter,
                                                .to = 1.6 * flutter,
                                                .count = 12,
                                                .speed = 20.0});
  const std::vector<StabilityBranch> rows = unstable_ones(table);
  ASSERT_EQ(rows.size(), 1u);
  // Two eigenvalues meet there: both the growth and its doubt go with the root of the distance.
  EXPECT_NEAR(rows[0].unstable.at(0).from.value, flutter, 1e-6 * flutter);
  EXPECT_EQ(rows[0].unstable.at(0).to.value, 1.6 * flutter);
  EXPECT_EQ(table.parameter, "friction");
  EXPECT_EQ(table.speed, 20.0);
  EXPECT_TRUE(table.families.empty());
  EXPECT_FALSE(nodal_diameters(table, rows[0]));
}

TEST(UnstableModes, OfTheRigidDiscBeginAtItsCriticalSpeed)
{
  // SQUEAL reference value with 40 digits; rounding as in RigidModel.
  const ModelOptions options{.model = RigidDiscStudy{.disc = source_disc()}, .study = {}};
  const StabilityTable table = unstable_modes(*model_brake(options), over_speeds(1.0, 20.0, 20));
  const std::vector<StabilityBranch> rows = unstable_ones(table);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(rows[0].unstable.at(0).from.value / pi, 9.478465586019481, 1e-7);
}

TEST(UnstableModes, OfABandAreThoseWithFrequenciesInIt)
{
  StabilityCase search = over_speeds(6.0, 7.0, 5);
  search.band = FrequencyBand{1000.0, 4000.0};
  const StabilityTable table = unstable_modes(plate(), search);
  ASSERT_FALSE(table.branches.empty());
  for (const StabilityBranch& branch : table.branches)
    EXPECT_TRUE(std::ranges::any_of(branch.lambda, [](const std::complex<double>& lambda) {
      return lambda.imag() > 2e3 * pi && lambda.imag() < 8e3 * pi;
    }));
  EXPECT_EQ(summary(table), "2 of 4 modes are unstable somewhere");
  search.band = FrequencyBand{1000.0, 16000.0};
  EXPECT_EQ(error_of_action([&] { unstable_modes(plate(), search); }),
            "[squeal] stability.band_Hz = [1000, 16000] goes beyond the modes of the body, 584.127 "
            "to 14289.9 Hz; end it there, or take a body with more modes");
}

TEST(UnstableModes, TellTheErrorOfTheirGrowth)
{
  constexpr double error = 1e-4;
  const StabilityCase search = over_speeds(1.0, 20.0, 20);
  Disc disc = disc_of({kirchhoff_3()});
  Disc off = disc;
  off.omega *= 1.0 + error;
  disc.errors = {.mesh = Eigen::VectorXd::Constant(2, error),
                 .reduction = Eigen::VectorXd::Constant(2, 0.1 * error),
                 .range = 2.0 * disc.omega.maxCoeff()};
  const auto all = std::make_shared<const FlexibleDisc>(plate());
  const StabilityBranch row =
      unstable_ones(unstable_modes(FlexibleDisc(disc, reference_options(), all), search)).at(0);
  const auto growth_there = [&](const FlexibleDisc& other) {
    const std::vector<StabilityBranch> rows = unstable_ones(unstable_modes(other, search));
    const auto nearest = std::ranges::min_element(rows, {}, [&](const StabilityBranch& branch) {
      return std::abs(branch.worst.frequency_Hz - row.worst.frequency_Hz);
    });
    EXPECT_EQ(nearest->worst.value, row.worst.value);
    return nearest->worst.growth;
  };
  const double found =
      std::abs(growth_there(FlexibleDisc(off, reference_options())) - row.worst.growth);
  EXPECT_GT(found, 1e-5);
  EXPECT_NEAR(row.budget.mesh.value(), found, 1e-2 * found);
  EXPECT_NEAR(row.budget.reduction.value(), 0.1 * found, 1e-3 * found);
  EXPECT_FALSE(row.budget.body);
  const double left_out = std::abs(growth_there(*all) - row.worst.growth);
  EXPECT_NEAR(row.budget.left_out.value(), left_out, 1e-9 + 1e-6 * left_out);
  disc.errors.range = 0.5 * disc.omega.maxCoeff();
  EXPECT_TRUE(unstable_ones(unstable_modes(FlexibleDisc(disc, reference_options()), search))
                  .at(0)
                  .budget.is_empty());
}

TEST(UnstableModes, ComeBackFromTheirFile)
{
  const files::test::ScratchFolder folder;
  SquealOptions options = reference_options();
  options.study.speeds.count = 6;
  options.study.analyses = {"stability"};
  options.study.stability = StabilityCase{.over = MapParameter::friction,
                                          .from = 0.1,
                                          .to = 0.9,
                                          .count = 4,
                                          .speed = 6.0 * pi,
                                          .band = FrequencyBand{500.0, 14000.0}};
  SquealResults written = run(plate(options), options.study);
  written.stability_table->branches.at(1).budget = {.mesh = 0.0, .left_out = 0.3};
  write_results(folder.path() / "table.squeal.h5", written, {});
  const StabilityTable a = written.stability_table.value();
  const StabilityTable b = read_results(folder.path() / "table.squeal.h5").stability_table.value();
  EXPECT_EQ(b.parameter, "friction");
  EXPECT_EQ(b.speed, a.speed);
  EXPECT_EQ(b.band->to_Hz, 14000.0);
  EXPECT_EQ(b.values, a.values);
  ASSERT_EQ(b.families.size(), 19u);
  EXPECT_EQ(b.families[3].nodal_diameters, a.families[3].nodal_diameters);
  EXPECT_EQ(b.families[3].frequency_Hz, a.families[3].frequency_Hz);
  ASSERT_EQ(b.branches.size(), a.branches.size());
  EXPECT_TRUE(b.branches[0].budget.is_empty());
  EXPECT_EQ(b.branches[1].budget.mesh, 0.0);
  EXPECT_FALSE(b.branches[1].budget.body);
  EXPECT_EQ(b.branches[1].budget.left_out, 0.3);
  EXPECT_GE(unstable_ones(a).size(), 4u);
  for (std::size_t j = 0; j < a.branches.size(); ++j) {
    EXPECT_EQ(b.branches[j].lambda, a.branches[j].lambda);
    EXPECT_EQ(b.branches[j].shares, a.branches[j].shares);
    EXPECT_EQ(b.branches[j].worst.growth, a.branches[j].worst.growth);
    ASSERT_EQ(b.branches[j].unstable.size(), a.branches[j].unstable.size());
    for (std::size_t i = 0; i < a.branches[j].unstable.size(); ++i)
      EXPECT_EQ(b.branches[j].unstable[i].from.value, a.branches[j].unstable[i].from.value);
  }
}

TEST(UnstableModes, SayWhatIsWrongWithTheirRange)
{
  const auto error_with = [](const std::function<void(StabilityCase&)>& change) {
    SquealOptions options = reference_options();
    options.study.analyses = {"stability"};
    options.study.stability = over_speeds(1.0, 2.0, 3);
    change(*options.study.stability);
    return error_of_action([&] { run(plate(options), options.study); });
  };
  EXPECT_EQ(error_with([](auto& s) { s.count = 1; }),
            "[squeal] stability.count = 1; it must be 2 or more for \"stability\"");
  EXPECT_EQ(error_with([](auto& s) { s.over = MapParameter::preload; }),
            "[squeal] stability.speed_rad_s = 0; it must be a number > 0");
  EXPECT_NE(error_with([](auto& s) { s.to = s.from; }).find("stability: to = "), std::string::npos);
  EXPECT_NE(error_with([](auto& s) {
              s.band = FrequencyBand{3.0, 2.0};
            }).find("stability.band_Hz"),
            std::string::npos);
}

}  // namespace
}  // namespace chladni::squeal
