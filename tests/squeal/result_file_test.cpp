#include "squeal/results/squeal_results.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "common/error.hpp"
#include "common/files/hdf5.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study/study.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/mbs_export/damaged_numbers.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "version_1_results.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using files::test::ScratchFolder, files::test::error_of;

SquealResults complete_results()
{
  SquealOptions options = reference_options();
  options.study.speeds.count = 5;
  options.study.analyses = {"eigenvalues",  "critical-speed",     "growth",
                            "limit-cycle",  "limit-cycle-direct", "limit-cycle-branch",
                            "stability-map"};
  options.study.map =
      MapCase{.parameter = MapParameter::preload, .from = 500.0, .to = 2000.0, .count = 3};
  options.study.limit_cycle_direct = DirectCase{.speed = 6.0 * pi};
  options.study.transient =
      TransientCase{.speed = 6.0 * pi, .duration = 0.2, .initial_pad_displacement = 4e-4};
  options.study.growth = GrowthCase{.speeds = {5.0 * pi, 6.0 * pi}, .duration = 0.1};
  return run(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study);
}

SweepTable three_variants()
{
  files::RowMajorMatrix values(3, 2);
  values << 0.6, 2000.0, 0.5, 2000.0, 0.1 + 0.2, 1e-7;
  SweepTable sweep = empty_sweep({"squeal.friction", "squeal.pads[1].preload"}, values,
                                 {{"critical_speed_rad_s", "rad/s"}, {"growth, 1/s", "1/s"}});
  sweep.results.row(0) << 17.25, -3.5;
  sweep.known.row(0) << 1, 1;
  sweep.results(1, 1) = 2.0;
  sweep.known(1, 1) = 1;
  sweep.states = {VariantState::done, VariantState::failed, VariantState::to_do};
  sweep.failures[1] = "transient: \"it\", diverged";
  sweep.inputs = "0123456789abcdef";
  return sweep;
}

TEST(SweepFile, ReturnsEveryValueItWasGiven)
{
  const ScratchFolder folder;
  const SweepTable written = three_variants();
  EXPECT_EQ(written.count(VariantState::failed), 1u);
  write_sweep(folder.file("disc.sweep.h5"), written, {});
  const SweepTable read = read_sweep(files::Reader(folder.file("disc.sweep.h5")));
  EXPECT_EQ(read.keys, written.keys);
  EXPECT_EQ(read.values, written.values);
  EXPECT_EQ(read.columns, written.columns);
  EXPECT_EQ(read.results, written.results);
  EXPECT_EQ(read.known, written.known);
  EXPECT_EQ(read.states, written.states);
  EXPECT_EQ(read.failures, written.failures);
  EXPECT_EQ(read.inputs, written.inputs);
  EXPECT_EQ(name_of_variant(read, 2),
            "squeal.friction = 0.30000000000000004, squeal.pads[1].preload = 1e-07");
  EXPECT_EQ(csv_of(read),
            "variant,squeal.friction,squeal.pads[1].preload,critical_speed_rad_s,\"growth, 1/s\","
            "failure\n"
            "1,0.6,2000,17.25,-3.5,\n"
            "2,0.5,2000,,2,\"transient: \"\"it\"\", diverged\"\n"
            "3,0.30000000000000004,1e-07,,,\n");
}

TEST(SweepFile, HasNoStatesAndFailuresOfOthers)
{
  const ScratchFolder folder;
  const auto refusal = [&](const SweepTable& sweep) {
    write_sweep(folder.file("bad.sweep.h5"), sweep, {});
    return error_of([&] { read_sweep(files::Reader(folder.file("bad.sweep.h5"))); });
  };
  SweepTable sweep = three_variants();
  for (const int state : {-1, 3}) {
    sweep.states[1] = static_cast<VariantState>(state);
    EXPECT_NE(refusal(sweep).find("states: expected 0, 1 or 2"), std::string::npos);
  }
  sweep = three_variants();
  sweep.states.push_back(VariantState::to_do);
  sweep.failures.emplace_back("of a fourth variant");
  EXPECT_NE(refusal(sweep).find("bad.sweep.h5: states"), std::string::npos) << refusal(sweep);
  sweep.states.pop_back();
  EXPECT_EQ(refusal(sweep), "") << "only failures of variants are written";
}

TEST(ResultFile, ReturnsTheExponentsOfARotation)
{
  SquealOptions options = reference_options();
  options.study.speeds.count = 4;
  options.study.analyses = {"rotation-stability"};
  PlatePair pair = kirchhoff_3();
  pair.split = 0.02;
  const SquealResults written = run(FlexibleDisc(disc_of({pair}), options), options.study);
  const SquealResults read = returned(written);
  expect_equal(read.rotation_stability, written.rotation_stability);
  const RotationStability &a = *written.rotation_stability, &b = *read.rotation_stability;
  EXPECT_EQ(b.error, a.error);
  EXPECT_EQ(b.harmonics, a.harmonics);
  EXPECT_EQ(b.method, "hill");
  EXPECT_GT(b.harmonics, 0);
}

TEST(ResultFile, ReturnsEveryValueItWasGiven)
{
  SquealResults written = complete_results();
  written.limit_cycle_branch->lost_below = 18.0;
  ASSERT_TRUE(written.limit_cycle_branch->origin);
  written.limit_cycle_branch->note = "a second part";
  written.limit_cycle_branch->second_part = 2;
  written.limit_cycle_direct->way = "by a detour";
  written.critical_speed->budget = {.mesh = 0.1, .reduction = 2e-9, .body = {}, .left_out = 0.3};
  written.limit_cycle_direct->errors = {.frequency_Hz = {.mesh = 0.2, .integration = 0.0},
                                        .pad_displacement = {.body = 3e-6}};
  ASSERT_TRUE(written.limit_cycle_branch->points.at(1).multiplier_error);
  written.limit_cycle_branch->points[1].multiplier_error = {};
  ASSERT_TRUE(written.transient->t_zero_force);
  const SquealResults read = returned(written);
  EXPECT_EQ(read.largest_split, written.largest_split);
  EXPECT_EQ(read.eigenvalues->speeds, written.eigenvalues->speeds);
  EXPECT_EQ(read.eigenvalues->lambda, written.eigenvalues->lambda);
  expect_equal(read.critical_speed, written.critical_speed);
  ASSERT_EQ(written.growth.size(), 2u);
  EXPECT_EQ(files::difference(read.growth, written.growth), "");
  expect_equal(read.transient, written.transient);
  expect_equal(read.limit_cycle, written.limit_cycle);
  expect_equal(read.map, written.map);
  expect_equal(read.limit_cycle_branch, written.limit_cycle_branch);
  expect_equal(read.limit_cycle_direct, written.limit_cycle_direct);
  EXPECT_EQ(read.limit_cycle_branch->second_part, 2u);
  ASSERT_TRUE(read.limit_cycle_branch->origin);
  const BranchOrigin &a = *read.limit_cycle_branch->origin,
                     &b = *written.limit_cycle_branch->origin;
  EXPECT_EQ(a.speed, b.speed);
  EXPECT_EQ(a.frequency_Hz, b.frequency_Hz);
  EXPECT_EQ(files::difference(a.first, b.first), "");
}

TEST(ResultFile, KeepsTheSensitivityToModes)
{
  SquealResults results;
  results.mode_sensitivity = ModeSensitivity{.critical_speed = 13.0,
                                             .critical_frequency_Hz = 1700.0,
                                             .subsets = {{.n_modes = 2,
                                                          .highest_Hz = 600.0,
                                                          .critical_speed = {},
                                                          .critical_frequency_Hz = {},
                                                          .growth = -0.5,
                                                          .stability = "as named"}},
                                             .influences = {{.nodal_diameters = 3,
                                                             .frequency_Hz = 1672.0,
                                                             .participation = 0.9,
                                                             .growth_without = {},
                                                             .critical_speed_without = {}},
                                                            {.nodal_diameters = 0,
                                                             .frequency_Hz = 700.0,
                                                             .participation = 0.1,
                                                             .growth_without = 0.25,
                                                             .critical_speed_without = 12.0}}};
  expect_equal(returned(results).mode_sensitivity, results.mode_sensitivity);
}

TEST(ResultFile, SaysWhatIsMissing)
{
  SquealResults results;
  results.missing = {"transient", "limit-cycle"};
  results.inputs = "body 0123";
  EXPECT_EQ(returned(results).missing, results.missing);
  EXPECT_EQ(returned(results).inputs, results.inputs);
  EXPECT_TRUE(returned({}).missing.empty());
}

TEST(ResultFile, TellsNoCriticalSpeedFromNoSearch)
{
  SquealResults results;
  EXPECT_FALSE(returned(results).searched_critical_speed);
  results.searched_critical_speed = true;
  EXPECT_TRUE(returned(results).searched_critical_speed);
  EXPECT_FALSE(returned(results).critical_speed);
}

void expect_equal_profiles(const std::optional<StabilityProfile>& read,
                           const StabilityProfile& written)
{
  ASSERT_TRUE(read);
  EXPECT_EQ(files::difference(read->from, written.from), "");
  EXPECT_EQ(files::difference(read->to, written.to), "");
  EXPECT_EQ(files::difference(read->unstable, written.unstable), "");
}

TEST(ResultFile, KeepsTheUnstableIntervals)
{
  const StabilityProfile none{{1.0, -2.0, 300.0}, {9.0, -0.5, 310.0}, {}};
  const StabilityProfile two{{1.0, 0.25, 300.0},
                             {9.0, 0.5, 310.0},
                             {{{1.0, 0.25, 300.0}, {2.0, 0.0, 301.0}, {1.5, 0.75, 302.0}},
                              {{7.0, 0.0, 303.0}, {9.0, 0.5, 310.0}, {8.0, 1.5, 304.0}}}};
  SquealResults results;
  results.searched_critical_speed = true;
  results.speed_stability = two;
  results.critical_values = {{.parameter = "friction",
                              .speed = 10.0,
                              .value = {},
                              .frequency_Hz = 0.0,
                              .n_newton_steps = 0,
                              .profile = none}};
  const SquealResults read = returned(results);
  EXPECT_FALSE(read.critical_speed);
  expect_equal_profiles(read.speed_stability, two);
  ASSERT_EQ(read.critical_values.size(), 1u);
  expect_equal_profiles(read.critical_values[0].profile, none);
}

MotionStatistics statistics()
{
  return {.speed = 20.0,
          .from = 1.5,
          .n_rotations = 6,
          .band_Hz = 12e3,
          .rms_velocity = 0.7,
          .peak_velocity = 1.4,
          .rms_displacement = 7e-5,
          .peak_displacement = 1.5e-4,
          .N_min = -3.0,
          .N_max = 4000.0,
          .open = 0.25,
          .drift = -0.02,
          .settled = false,
          .rms_over_angle = Eigen::Vector3d(0.6, 0.7, 0.8),
          .modulation = 1.0 / 7.0,
          .lines = {{1000.0, 1.0, 0.0}, {980.9, 0.2, -6.0}, {2500.0, 0.1, 471.24}}};
}

TEST(ResultFile, ReturnsStatisticsOfTheMotion)
{
  SquealResults results;
  results.motion_statistics = statistics();
  expect_equal(returned(results).motion_statistics, results.motion_statistics);
}

TEST(ResultFile, RefusesStatisticsWithoutAPartOfARotation)
{
  SquealResults results;
  results.motion_statistics = statistics();
  results.motion_statistics->rms_over_angle.resize(0);
  const std::string error = error_of([&] { returned(results); });
  EXPECT_NE(error.find("motion_statistics/rms_over_angle"), std::string::npos) << error;
}

TEST(ResultFile, ReturnsCirclesAndSharesWhereTheyAreKnown)
{
  SquealResults results;
  StabilityTable table{.parameter = "pads[2].stiffness",
                       .speed = 10.0,
                       .band = {},
                       .values = Eigen::Vector2d(1e6, 2e6),
                       .families = {{2, 800.0, 1, 0.25}, {3, 1700.0, {}, {}}, {0, 600.0, 0, 0.0}},
                       .branches = {}};
  StabilityBranch branch{};
  branch.lambda = Eigen::VectorXcd::Constant(2, {-1.0, 5000.0});
  branch.shares = Eigen::Vector3d(0.5, 0.25, 0.25);
  table.branches = {branch};
  results.stability_table = table;
  const auto read = returned(results).stability_table;
  ASSERT_TRUE(read);
  EXPECT_EQ(read->parameter, "pads[2].stiffness");
  EXPECT_EQ(files::difference(read->families, table.families), "");
}

TEST(ResultFile, NamesFormatUnitsAndOrigin)
{
  const ScratchFolder folder;
  const std::string path = folder.file("x.squeal.h5");
  mbs_export::Provenance provenance;
  provenance.scene = "title = \"x\"";
  write_results(path, complete_results(), provenance);
  const files::Reader reader(path);
  EXPECT_NO_THROW(reader.expect_format("chladni-squeal", 1));
  EXPECT_EQ(reader.text("provenance/scene"), "title = \"x\"");
  EXPECT_EQ(reader.text_attribute("transient/tail/N_up", "unit"), "N");
  EXPECT_EQ(reader.text_attribute("eigenvalues/speeds", "unit"), "rad/s");
  EXPECT_EQ(reader.text_attribute("stability_map/values", "unit"), "N");
}

TEST(ResultFile, RefusesANumberThatIsNoneInAnyDataset)
{
  const ScratchFolder folder;
  const std::string path = folder.file("x.squeal.h5");
  write_results(path, complete_results(), {});
  const auto names = mbs_export::test::real_datasets(path);
  EXPECT_GT(names.size(), 60u);
  for (const std::string& name : names) {
    const double before = mbs_export::test::replace_last(path, name, std::nan(""));
    const std::string error = error_of([&] { read_results(std::filesystem::path(path)); });
    EXPECT_NE(error.find(name + ": value "), std::string::npos) << name << ": " << error;
    mbs_export::test::replace_last(path, name, before);
  }
}

TEST(ResultFile, RefusesFilesThatAreNotResults)
{
  const ScratchFolder folder;
  const std::string path = folder.file("x.squeal.h5");
  EXPECT_THROW(read_results(std::filesystem::path(path)), Error);
  std::ofstream(path) << "no results";
  EXPECT_THROW(read_results(std::filesystem::path(path)), Error);
  EXPECT_THROW(write_results("/nowhere/at/all/x.squeal.h5", {}, {}), Error);
}

}  // namespace
}  // namespace chladni::squeal
