#include "squeal/stability/unstable_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

StabilityCase speeds_of_periods(double from, double to, int count)
{
  return {.over = {}, .from = from * pi, .to = to * pi, .count = count};
}

std::vector<StabilityBranch> unstable_rows(const StabilityTable& table)
{
  std::vector<StabilityBranch> rows;
  for (const StabilityBranch& row : table.branches)
    if (row.is_unstable()) rows.push_back(row);
  return rows;
}

double sum_of(const PeriodWork& work)
{
  return work.friction + work.normal + work.damping;
}

TEST(PeriodWork, OfAllForcesIsWhatAModeGains)
{
  // For x = Re(u exp(lambda t)) the mean power is Re(u^H A u) / 2 = Re(lambda) |u|^2 / 2 and the
  // mean energy |u|^2 / 4: works sum to 2 growth / frequency. Here with damping of modes and pads,
  // a plate with a mass, and a table over friction.
  SquealOptions damped = reference_options();
  damped.pads[0].damping = 3.0;
  SquealOptions plates = reference_options();
  plates.pads[0].body = PadBody{.mass = 0.4, .axial = Suspension{2e7, 30.0}};
  StabilityCase over_friction = speeds_of_periods(0.1, 0.3, 9);
  over_friction.over = MapParameter::friction;
  over_friction.speed = 6.0 * pi;
  int n_fed = 0;
  for (const SquealOptions& options : {reference_options(), damped, plates}) {
    for (const StabilityCase& search : {speeds_of_periods(1.0, 20.0, 20), over_friction}) {
      const FlexibleDisc brake(disc_of({kirchhoff_2(), kirchhoff_3(), kirchhoff_4()}), options);
      for (const StabilityBranch& row : unstable_rows(unstable_modes(brake, search))) {
        ASSERT_TRUE(row.work);
        const double gain = 2.0 * row.worst.growth / row.worst.frequency_Hz;
        EXPECT_NEAR(sum_of(*row.work), gain, 1e-6 * std::abs(row.work->friction) + 1e-10);
        n_fed += row.work->friction > 0.0;
      }
    }
  }
  EXPECT_GT(n_fed, 6);
}

TEST(PeriodWork, ComesBackFromItsFile)
{
  const files::test::ScratchFolder folder;
  const std::string path = folder.path() / "work.squeal.h5";
  SquealResults written;
  written.stability_table =
      unstable_modes(FlexibleDisc(disc_of({kirchhoff_2(), kirchhoff_3()}), reference_options()),
                     speeds_of_periods(1.0, 20.0, 4));
  write_results(path, written, {});
  const StabilityTable a = *written.stability_table;
  const StabilityTable b = read_results(path).stability_table.value();
  ASSERT_EQ(b.branches.size(), a.branches.size());
  ASSERT_FALSE(unstable_rows(a).empty());
  for (std::size_t j = 0; j < a.branches.size(); ++j) {
    ASSERT_EQ(b.branches[j].work.has_value(), a.branches[j].is_unstable());
    if (!a.branches[j].work) continue;
    EXPECT_EQ(b.branches[j].work->friction, a.branches[j].work->friction);
    EXPECT_EQ(b.branches[j].work->normal, a.branches[j].work->normal);
    EXPECT_EQ(b.branches[j].work->damping, a.branches[j].work->damping);
  }
}

TEST(PeriodWork, IsThatOnTheModesWithInertia)
{
  // The others yield to the pads and hold no energy.
  std::vector<PlatePair> pairs{kirchhoff_3()};
  for (int n = 0; n < 5; ++n) {
    pairs.push_back({.n = n,
                     .f_Hz = 2e4,
                     .mass = 0.1,
                     .U = 0.5 + 0.1 * n,
                     .U_r = 9.0 - 3.0 * n,
                     .U_t = n * 4.1});
  }
  mbs_export::ModalBody body = analytic_body(pairs);
  for (std::size_t i = 2; i < body.kinds.size(); ++i)
    body.kinds[i] = mbs_export::ModeKind::interface;
  SquealOptions options = reference_options();
  options.pads.push_back({.angle = 1.1, .stiffness = 4e6, .damping = 1.0, .preload = 1500.0});
  const FlexibleDisc brake(disc_on_ring(body, "track", {}), options);
  ASSERT_FALSE(brake.disc().compliance.empty());
  const auto rows = unstable_rows(unstable_modes(brake, speeds_of_periods(1.0, 20.0, 20)));
  ASSERT_FALSE(rows.empty());
  for (const StabilityBranch& row : rows) {
    EXPECT_NEAR(sum_of(row.work.value()), 2.0 * row.worst.growth / row.worst.frequency_Hz,
                1e-6 * std::abs(row.work->friction));
  }
}

}  // namespace
}  // namespace chladni::squeal
