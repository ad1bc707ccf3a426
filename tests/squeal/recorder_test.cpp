#include "squeal/transient/recorder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "squeal/transient/resampling.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

TEST(PeakFinder, FindsThePeakBetweenTheSamples)
{
  // 40 samples per period, none of them on the peak at 1 / 4 or 3 / 4 of the period. The parabola
  // leaves about (2 pi / 40)^4 / 100 = 6e-6 of the amplitude, the samples alone miss up to 3e-3.
  PeakFinder peaks;
  const double step = 1.0 / 40.0;
  for (int i = 0; i <= 45; ++i) {
    const double t = (i + 0.3) * step;
    peaks.add(t, 2.0 * std::sin(2.0 * pi * t), step);
  }
  const auto peak = peaks.take();
  ASSERT_TRUE(peak);
  EXPECT_NEAR(peak->value, 2.0, 2e-5);
  EXPECT_NEAR(std::abs(peak->t - 0.5), 0.25, 1e-2 * step);
  EXPECT_FALSE(peaks.take()) << "taken once";
}

TEST(PeakFinder, TakesTheLargestOfBothSigns)
{
  PeakFinder peaks;
  for (const double x : {0.0, 1.0, 0.0, -3.0, 0.0, 2.0, 0.0}) peaks.add(0.0, x, 1.0);
  EXPECT_DOUBLE_EQ(peaks.take()->value, 3.0);
}

Envelope exponential(double rate, int n)
{
  Envelope envelope;
  for (int i = 0; i < n; ++i) {
    envelope.t.push_back(0.01 * i);
    envelope.pad_velocity.push_back(std::exp(rate * 0.01 * i));
    envelope.pad_displacement.push_back(1e-4 * std::exp(rate * 0.01 * i));
  }
  return envelope;
}

TEST(GrowthRate, IsTheExponentOfAnExponential)
{
  EXPECT_NEAR(growth_rate(exponential(2.5, 100), 1.0).value(), 2.5, 1e-12);
  EXPECT_NEAR(growth_rate(exponential(-0.7, 100), 1.0).value(), -0.7, 1e-12);
}

TEST(GrowthRate, EndsWithTheLinearPhase)
{
  Envelope envelope = exponential(2.5, 200);
  for (std::size_t i = 100; i < 200; ++i) {
    envelope.pad_velocity[i] = envelope.pad_velocity[100];
    envelope.pad_displacement[i] = 1.0;
  }
  EXPECT_NEAR(growth_rate(envelope, 0.5).value(), 2.5, 1e-12);
}

TEST(GrowthRate, IsAbsentWithTooFewPoints)
{
  EXPECT_FALSE(growth_rate(exponential(2.5, 10), 1.0));
  EXPECT_FALSE(growth_rate(exponential(2.5, 100), 1e-5));
}

/// Samples k of a sine over the decimated ones; the time of a sample is its number.
std::vector<double> decimated_sine(const Decimation& decimation, int n, double frequency)
{
  Decimator decimator(decimation, 1);
  std::vector<double> out;
  for (int i = 0; i < n; ++i) {
    if (const auto x =
            decimator.add(Eigen::VectorXd::Constant(1, std::sin(2.0 * pi * frequency * i))))
      out.push_back((*x)[0]);
  }
  for (const auto& x : decimator.finish()) out.push_back(x[0]);
  return out;
}

TEST(Decimator, KeepsTheBandItNamesAndNothingElse)
{
  for (const Decimation& decimation : {Decimation{5, 1}, Decimation{3, 2}, Decimation{8, 2}}) {
    const auto every = static_cast<int>(decimation.every());
    const int n = 400 * every + 1;
    // The upper end of the band; what would fold down to 0.1 of the new rate.
    const double kept = decimated_band / every, folded = 1.1 / every;
    const std::vector<double> low = decimated_sine(decimation, n, kept),
                              high = decimated_sine(decimation, n, folded);
    ASSERT_EQ(low.size(), 401u) << every;
    for (std::size_t j = 60; j < 340; ++j) {  // ripples of the window, of one stage or two
      EXPECT_NEAR(low[j], std::sin(2.0 * pi * kept * double(j) * every), 1e-3) << every << " " << j;
      EXPECT_NEAR(high[j], 0.0, 5e-4) << every << " " << j;
    }
  }
}

TEST(Decimator, LeavesAConstantAloneUpToBothEnds)
{
  Decimator decimator({4, 2}, 2);
  std::vector<Eigen::VectorXd> out;
  for (int i = 0; i < 1000; ++i)
    if (const auto x = decimator.add(Eigen::Vector2d(3.0, -1.0))) out.push_back(*x);
  for (const auto& x : decimator.finish()) out.push_back(x);
  ASSERT_EQ(out.size(), 63u);
  for (const Eigen::VectorXd& x : out) EXPECT_LT((x - Eigen::Vector2d(3.0, -1.0)).norm(), 1e-14);
}

TEST(Decimation, KeepsNoMoreThanItMay)
{
  for (const std::int64_t n : {1, 7, 100, 101, 900, 6400, 1000000, 2000000000}) {
    const Decimation decimation = decimation_to(n, 100);
    EXPECT_LE((n - 1) / decimation.every() + 1, 100) << n;
    EXPECT_LE(decimation.factor, 9) << n;
    EXPECT_EQ(decimation.every() == 1, n <= 100) << n;
  }
}

}  // namespace
}  // namespace chladni::squeal
