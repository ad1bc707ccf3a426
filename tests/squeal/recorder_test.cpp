#include "squeal/recorder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "squeal/growth_rate.hpp"

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

}  // namespace
}  // namespace chladni::squeal
