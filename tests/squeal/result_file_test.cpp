#include "squeal/results/squeal_results.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "common/error.hpp"
#include "common/files/hdf5.hpp"
#include "squeal/study/study.hpp"
#include "tests/mbs_export/damaged_numbers.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// A file name of this process, removed at the end.
struct TemporaryFile {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               ("result_file_test-" + std::to_string(getpid()) + ".h5");
  ~TemporaryFile() { std::filesystem::remove(path); }
};

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

TEST(ResultFile, ReturnsTheExponentsOfARotation)
{
  const TemporaryFile file;
  SquealOptions options = reference_options();
  options.study.speeds.count = 4;
  options.study.analyses = {"rotation-stability"};
  PlatePair pair = kirchhoff_3();
  pair.split = 0.02;
  const SquealResults written = run(FlexibleDisc(disc_of({pair}), options), options.study);
  write_results(file.path, written, {});
  const RotationStability a = *written.rotation_stability;
  const RotationStability b = read_results(file.path).rotation_stability.value();
  EXPECT_EQ(b.growth, a.growth);
  EXPECT_EQ(b.method, "hill");
  EXPECT_GT(b.harmonics, 0);
  EXPECT_EQ(b.harmonics, a.harmonics);
  EXPECT_EQ(b.error, a.error);
  EXPECT_EQ(b.exponents, a.exponents);
  EXPECT_EQ(b.frozen_growth, a.frozen_growth);
}

TEST(ResultFile, ReturnsEveryValueItWasGiven)
{
  const TemporaryFile file;
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
  write_results(file.path, written, {});
  const SquealResults read = read_results(file.path);
  EXPECT_EQ(read.largest_split, written.largest_split);
  EXPECT_EQ(read.eigenvalues->speeds, written.eigenvalues->speeds);
  EXPECT_EQ(read.eigenvalues->lambda, written.eigenvalues->lambda);
  EXPECT_EQ(read.critical_speed->speed, written.critical_speed->speed);
  EXPECT_EQ(read.critical_speed->budget.mesh, 0.1);
  EXPECT_EQ(read.critical_speed->budget.reduction, 2e-9);
  EXPECT_FALSE(read.critical_speed->budget.body);
  EXPECT_EQ(read.critical_speed->budget.left_out, 0.3);
  ASSERT_EQ(read.growth.size(), 2u);
  EXPECT_EQ(read.growth[1].rate, written.growth[1].rate);
  EXPECT_EQ(read.growth[1].eigenvalue_rate, written.growth[1].eigenvalue_rate);
  EXPECT_EQ(read.growth[0].envelope.pad_velocity, written.growth[0].envelope.pad_velocity);
  EXPECT_EQ(read.transient->tail.N_up, written.transient->tail.N_up);
  EXPECT_EQ(read.transient->history.t, written.transient->history.t);
  ASSERT_TRUE(written.transient->t_zero_force);
  EXPECT_EQ(read.transient->t_zero_force, written.transient->t_zero_force);
  EXPECT_EQ(read.transient->growth_rate, written.transient->growth_rate);
  EXPECT_EQ(read.limit_cycle->frequency_Hz, written.limit_cycle->frequency_Hz);
  EXPECT_EQ(read.limit_cycle->amplitude, written.limit_cycle->amplitude);
  EXPECT_EQ(read.limit_cycle->mode_numbers, written.limit_cycle->mode_numbers);
  ASSERT_TRUE(read.map);
  EXPECT_EQ(read.map->parameter, "preload");
  EXPECT_EQ(read.map->values, written.map->values);
  EXPECT_EQ(read.map->growth, written.map->growth);
  EXPECT_EQ(read.map->frequency_Hz, written.map->frequency_Hz);
  EXPECT_EQ(read.limit_cycle_branch->lost_below, 18.0);
  EXPECT_EQ(read.limit_cycle_branch->note, "a second part");
  EXPECT_EQ(read.limit_cycle_branch->second_part, 2u);
  EXPECT_EQ(read.limit_cycle_direct->way, "by a detour");
  ASSERT_TRUE(read.limit_cycle_branch->origin);
  const BranchOrigin &a = *read.limit_cycle_branch->origin,
                     &b = *written.limit_cycle_branch->origin;
  EXPECT_EQ(a.speed, b.speed);
  EXPECT_EQ(a.frequency_Hz, b.frequency_Hz);
  EXPECT_EQ(a.first.speed, b.first.speed);
  EXPECT_EQ(a.first.pad_velocity, b.first.pad_velocity);
  ASSERT_EQ(read.limit_cycle_branch->points.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read.limit_cycle_branch->points[i].speed,
              written.limit_cycle_branch->points[i].speed);
    EXPECT_EQ(read.limit_cycle_branch->points[i].largest_multiplier,
              written.limit_cycle_branch->points[i].largest_multiplier);
    EXPECT_EQ(read.limit_cycle_branch->points[i].multiplier_error,
              written.limit_cycle_branch->points[i].multiplier_error);
  }
  ASSERT_TRUE(read.limit_cycle_direct);
  const DirectLimitCycle &direct = *read.limit_cycle_direct,
                         &original = *written.limit_cycle_direct;
  EXPECT_EQ(direct.frequency_Hz, original.frequency_Hz);
  EXPECT_EQ(direct.multipliers, original.multipliers);
  EXPECT_EQ(direct.multiplier_error, original.multiplier_error);
  EXPECT_EQ(direct.errors.frequency_Hz.mesh, 0.2);
  EXPECT_EQ(direct.errors.frequency_Hz.integration, 0.0);
  EXPECT_FALSE(direct.errors.frequency_Hz.reduction);
  EXPECT_TRUE(direct.errors.pad_velocity.is_empty());
  EXPECT_EQ(direct.errors.pad_displacement.body, 3e-6);
  EXPECT_EQ(direct.n_contact_evaluations, original.n_contact_evaluations);
  EXPECT_EQ(direct.x, original.x);
  EXPECT_EQ(direct.amplitude, original.amplitude);
}

TEST(ResultFile, KeepsTheSensitivityToModes)
{
  const TemporaryFile file;
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
  write_results(file.path, results, {});
  const auto read = read_results(file.path).mode_sensitivity;
  ASSERT_TRUE(read);
  EXPECT_EQ(read->critical_speed, 13.0);
  ASSERT_EQ(read->subsets.size(), 1u);
  EXPECT_FALSE(read->subsets[0].critical_speed);
  EXPECT_EQ(read->subsets[0].growth, -0.5);
  EXPECT_EQ(read->subsets[0].stability, "as named");
  ASSERT_EQ(read->influences.size(), 2u);
  EXPECT_FALSE(read->influences[0].growth_without);
  EXPECT_EQ(read->influences[1].critical_speed_without, 12.0);
  EXPECT_EQ(read->influences[1].nodal_diameters, 0);
}

TEST(ResultFile, SaysWhatIsMissing)
{
  const TemporaryFile file;
  SquealResults results;
  results.missing = {"transient", "limit-cycle"};
  results.inputs = "body 0123";
  write_results(file.path, results, {});
  EXPECT_EQ(read_results(file.path).missing, results.missing);
  EXPECT_EQ(read_results(file.path).inputs, results.inputs);
  write_results(file.path, {}, {});
  EXPECT_TRUE(read_results(file.path).missing.empty());
}

TEST(ResultFile, TellsNoCriticalSpeedFromNoSearch)
{
  const TemporaryFile file;
  SquealResults results;
  write_results(file.path, results, {});
  EXPECT_FALSE(read_results(file.path).searched_critical_speed);
  results.searched_critical_speed = true;
  write_results(file.path, results, {});
  EXPECT_TRUE(read_results(file.path).searched_critical_speed);
  EXPECT_FALSE(read_results(file.path).critical_speed);
}

void expect_equal(const StabilityPoint& read, const StabilityPoint& written)
{
  EXPECT_EQ(read.value, written.value);
  EXPECT_EQ(read.growth, written.growth);
  EXPECT_EQ(read.frequency_Hz, written.frequency_Hz);
}

void expect_equal(const std::optional<StabilityProfile>& read, const StabilityProfile& written)
{
  ASSERT_TRUE(read);
  expect_equal(read->from, written.from);
  expect_equal(read->to, written.to);
  ASSERT_EQ(read->unstable.size(), written.unstable.size());
  for (std::size_t i = 0; i < written.unstable.size(); ++i) {
    expect_equal(read->unstable[i].from, written.unstable[i].from);
    expect_equal(read->unstable[i].to, written.unstable[i].to);
    expect_equal(read->unstable[i].worst, written.unstable[i].worst);
  }
}

TEST(ResultFile, KeepsTheUnstableIntervals)
{
  const TemporaryFile file;
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
  write_results(file.path, results, {});
  const SquealResults read = read_results(file.path);
  EXPECT_FALSE(read.critical_speed);
  expect_equal(read.speed_stability, two);
  ASSERT_EQ(read.critical_values.size(), 1u);
  expect_equal(read.critical_values[0].profile, none);
}

TEST(ResultFile, NamesFormatUnitsAndOrigin)
{
  const TemporaryFile file;
  mbs_export::Provenance provenance;
  provenance.scene = "title = \"x\"";
  write_results(file.path, complete_results(), provenance);
  const files::Reader reader(file.path.string());
  EXPECT_NO_THROW(reader.expect_format("chladni-squeal", 1));
  EXPECT_EQ(reader.text("provenance/scene"), "title = \"x\"");
  EXPECT_EQ(reader.text_attribute("transient/tail/N_up", "unit"), "N");
  EXPECT_EQ(reader.text_attribute("eigenvalues/speeds", "unit"), "rad/s");
  EXPECT_EQ(reader.text_attribute("stability_map/values", "unit"), "N");
}

TEST(ResultFile, RefusesANumberThatIsNoneInAnyDataset)
{
  const TemporaryFile file;
  write_results(file.path, complete_results(), {});
  const auto names = mbs_export::test::real_datasets(file.path);
  EXPECT_GT(names.size(), 60u);
  for (const std::string& name : names) {
    const double before = mbs_export::test::replace_last(file.path, name, std::nan(""));
    try {
      read_results(file.path);
      ADD_FAILURE() << name << " is read";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name + ": value "), std::string::npos)
          << error.what();
    }
    mbs_export::test::replace_last(file.path, name, before);
  }
}

TEST(ResultFile, RefusesFilesThatAreNotResults)
{
  const TemporaryFile file;
  EXPECT_THROW(read_results(file.path), Error);
  std::ofstream(file.path) << "no results";
  EXPECT_THROW(read_results(file.path), Error);
  EXPECT_THROW(write_results("/nowhere/at/all/x.squeal.h5", {}, {}), Error);
}

}  // namespace
}  // namespace chladni::squeal
