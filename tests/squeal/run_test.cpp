#include "squeal/study/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "common/error.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TEST(Run, YieldsWhatWasAskedForAndNothingElse)
{
  SquealOptions options = reference_options();
  options.study.analyses = {"critical-speed"};
  const SquealResults results = run(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study);
  EXPECT_TRUE(results.searched_critical_speed);
  EXPECT_TRUE(results.critical_speed);
  EXPECT_FALSE(results.eigenvalues || results.transient || results.limit_cycle);
  EXPECT_TRUE(results.growth.empty());
}

TEST(Run, PerformsTheTransientThatALimitCycleNeeds)
{
  SquealOptions options = reference_options();
  options.study.analyses = {"eigenvalues", "growth", "limit-cycle"};
  options.study.transient =
      TransientCase{.speed = 6.0 * pi, .duration = 0.2, .initial_pad_displacement = 1e-4};
  options.study.growth = GrowthCase{.speeds = {5.0 * pi, 6.0 * pi}, .duration = 0.3};
  std::set<std::string> names;
  std::vector<double> done;
  const SquealResults results = run(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study,
                                    {.progress = [&](const std::string& name, double whole) {
                                      names.insert(name);
                                      done.push_back(whole);
                                    }});
  EXPECT_TRUE(results.eigenvalues && results.transient && results.limit_cycle);
  EXPECT_EQ(results.growth.size(), 2u);
  EXPECT_FALSE(results.searched_critical_speed);
  EXPECT_EQ(names, (std::set<std::string>{"eigenvalues", "growth", "limit-cycle", "transient"}));
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_EQ(done.front(), 0.0);
  EXPECT_EQ(done.back(), 1.0);
}

TEST(Run, GoesOnWhereUnfinishedResultsCannotBeKept)
{
  SquealOptions options = reference_options();
  options.study.analyses = {"eigenvalues", "critical-speed"};
  int n_kept = 0;
  const StudyKeeping keeping{.unfinished = [&](const SquealResults&) {
    if (++n_kept > 1) throw Error("disk full");
  }};
  const SquealResults results =
      run(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study, keeping);
  EXPECT_EQ(n_kept, 2);
  EXPECT_TRUE(results.eigenvalues && results.critical_speed);
  EXPECT_FALSE(results.failure);
}

TEST(Run, FindsALimitCycleWithoutATransient)
{
  SquealOptions options = reference_options();
  options.study.analyses = {"limit-cycle-direct"};
  options.study.limit_cycle_direct = DirectCase{.speed = 6.0 * pi};
  const SquealResults results = run(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study);
  EXPECT_TRUE(results.limit_cycle_direct);
  EXPECT_FALSE(results.transient || results.limit_cycle || results.limit_cycle_branch);
}

TEST(Run, NeedsAnAxisymmetricDiscForLimitCyclesOnly)
{
  auto body = analytic_body({kirchhoff_3()});
  body.omega[1] *= 1.1;
  const Disc disc = disc_on_ring(body, "track", {});
  SquealOptions options = reference_options();
  options.study.limit_cycle_direct = DirectCase{.speed = 6.0 * pi};
  for (const char* analysis : {"limit-cycle-direct", "limit-cycle-branch", "mode-sensitivity"}) {
    options.study.analyses = {analysis};
    EXPECT_THROW(run(FlexibleDisc(disc, options), options.study), Error) << analysis;
  }
  options.study.analyses = {"transient"};
  options.study.transient =
      TransientCase{.speed = 6.0 * pi, .duration = 0.1, .initial_pad_displacement = 1e-6};
  EXPECT_TRUE(run(FlexibleDisc(disc, options), options.study).transient);
}

TEST(Run, ValidatesTheOptionsFirst)
{
  SquealOptions options = reference_options();
  options.friction.kinetic = -1.0;
  EXPECT_THROW(run(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study), Error);
}

}  // namespace
}  // namespace chladni::squeal
