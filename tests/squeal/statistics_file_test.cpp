// What later versions added to a result file: statistics of motions, circles and shares of modes.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "common/error.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::squeal {
namespace {

using files::test::ScratchFolder;

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

SquealResults returned(const SquealResults& written)
{
  const ScratchFolder folder;
  write_results(folder.file("x.squeal.h5"), written, {});
  return read_results(folder.file("x.squeal.h5"));
}

TEST(StatisticsFile, ReturnsEveryValueItWasGiven)
{
  SquealResults results;
  results.motion_statistics = statistics();
  const auto read = returned(results).motion_statistics;
  ASSERT_TRUE(read);
  const MotionStatistics a = statistics(), &b = *read;
  for (const auto member :
       {&MotionStatistics::speed, &MotionStatistics::from, &MotionStatistics::band_Hz,
        &MotionStatistics::rms_velocity, &MotionStatistics::peak_velocity,
        &MotionStatistics::rms_displacement, &MotionStatistics::peak_displacement,
        &MotionStatistics::N_min, &MotionStatistics::N_max, &MotionStatistics::open,
        &MotionStatistics::drift, &MotionStatistics::modulation})
    EXPECT_EQ(b.*member, a.*member);
  EXPECT_EQ(b.n_rotations, 6);
  EXPECT_FALSE(b.settled);
  EXPECT_EQ(b.rms_over_angle, a.rms_over_angle);
  ASSERT_EQ(b.lines.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(b.lines[i].frequency_Hz, a.lines[i].frequency_Hz);
    EXPECT_EQ(b.lines[i].amplitude, a.lines[i].amplitude);
    EXPECT_EQ(b.lines[i].rotations, a.lines[i].rotations);
  }
}

TEST(StatisticsFile, RefusesPartsThatAreNotThere)
{
  SquealResults results;
  results.motion_statistics = statistics();
  results.motion_statistics->rms_over_angle.resize(0);
  try {
    returned(results);
    ADD_FAILURE() << "statistics without a part of a rotation are read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("motion_statistics/rms_over_angle"),
              std::string::npos);
  }
}

TEST(StabilityTableFile, ReturnsCirclesAndSharesWhereTheyAreKnown)
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
  ASSERT_EQ(read->families.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read->families[i].nodal_circles, table.families[i].nodal_circles);
    EXPECT_EQ(read->families[i].in_plane, table.families[i].in_plane);
  }
}

}  // namespace
}  // namespace chladni::squeal
