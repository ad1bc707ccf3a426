#include "report/progress.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <vector>

#include "report/timing.hpp"

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

TEST(ProgressLog, HasFewLinesWithTheTimeLeft)
{
  ProgressLog log;
  EXPECT_FALSE(log.line("mesh", 0.1, 9.9));
  EXPECT_EQ(log.line("modes", 0.25, 10.0), "10 s: 25 %  modes, 30 s left");
  EXPECT_FALSE(log.line("modes", 0.3, 19.9));
  EXPECT_EQ(log.line("modes", 0.01, 21.0), "21 s: 1 %  modes");
  int n_lines = 0;
  for (int s = 22; s <= 3600; ++s) n_lines += log.line("modes", 0.5, s) ? 1 : 0;
  EXPECT_EQ(n_lines, 60);
}

#ifndef CHLADNI_SANITIZED  // malloc is another one there

long pages_touched_first()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

/// Matrices that together are more than glibc's heap keeps, and each below what it maps.
double sum_of_matrices()
{
  constexpr std::size_t n_matrices = 40, n = 12500;
  std::vector<std::vector<double>> matrices;
  for (std::size_t i = 0; i < n_matrices; ++i) matrices.emplace_back(n, 1.0);
  double sum = 0.0;
  for (const std::vector<double>& matrix : matrices) sum += matrix.back();
  return sum;
}

TEST(KeepFreedMemory, GivesTheNextMatricesThePagesOfTheLast)
{
  keep_freed_memory();
  double sum = sum_of_matrices();
  const long before = pages_touched_first();
  for (int i = 0; i < 20; ++i) sum += sum_of_matrices();
  EXPECT_EQ(sum, 21.0 * 40.0);
  constexpr long pages_of_all = 40 * 12500 * sizeof(double) / 4096;
  EXPECT_LT(pages_touched_first() - before, pages_of_all);  // of 20 times as many
}

#endif

}  // namespace
}  // namespace chladni::report
