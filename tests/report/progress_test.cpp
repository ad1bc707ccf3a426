#include "report/progress.hpp"

#include <gtest/gtest.h>

namespace chladni::report {
namespace {

TEST(WholeProgress, GoesThroughTheStages)
{
  WholeProgress progress({{"mesh", 1.0}, {"modes", 6.0}, {"write", 3.0}});
  EXPECT_DOUBLE_EQ(progress.at("mesh", 0.0), 0.0);
  EXPECT_DOUBLE_EQ(progress.at("mesh", 1.0), 0.1);
  EXPECT_DOUBLE_EQ(progress.at("modes", 0.5), 0.4);
  EXPECT_DOUBLE_EQ(progress.at("write", 0.0), 0.7);
  EXPECT_DOUBLE_EQ(progress.at("write", 1.0), 1.0);
}

TEST(WholeProgress, NeverFalls)
{
  WholeProgress progress(
      {{"constraint modes", 1.0}, {"modes", 8.0, Times::unknown}, {"write", 1.0}});
  double last = 0.0;
  const auto expect_no_less = [&](const std::string& phase, double fraction) {
    const double now = progress.at(phase, fraction);
    EXPECT_GE(now, last) << phase << ' ' << fraction;
    last = now;
  };
  expect_no_less("constraint modes", 1.0);
  for (int time = 0; time < 5; ++time) {
    for (const double fraction : {0.0, 0.5, 1.0}) expect_no_less("modes", fraction);
    EXPECT_GT(last, time == 0 ? 0.4 : 0.6);
    const double before = last;
    for (const double fraction : {0.0, 1.0}) expect_no_less("choice of modes", fraction);
    EXPECT_EQ(last, before);
    EXPECT_LT(last, 0.9);
  }
  expect_no_less("write", 0.0);
  EXPECT_DOUBLE_EQ(last, 0.9);
  expect_no_less("mesh", 0.5);
}

TEST(WholeProgress, PassesOverWhatARunLeavesOut)
{
  WholeProgress progress({{"mesh", 1.0}, {"count", 2.0}, {"write", 1.0}});
  progress.at("mesh", 1.0);
  EXPECT_DOUBLE_EQ(progress.at("write", 0.0), 0.75);
}

TEST(ProgressText, DrawsABarAndThenTheTimeLeft)
{
  EXPECT_EQ(progress_text("mesh", 0.5, 1.9), "[##########----------]  50 %  mesh");
  EXPECT_EQ(progress_text("transient", 0.25, 4.0),
            "[#####---------------]  25 %  transient, 12 s left");
  EXPECT_EQ(progress_text("transient", 0.0, 4.0), "[--------------------]   0 %  transient");
  EXPECT_EQ(progress_text("write", 1.5, 4.0), "[####################] 100 %  write, 0 s left");
}

}  // namespace
}  // namespace chladni::report
