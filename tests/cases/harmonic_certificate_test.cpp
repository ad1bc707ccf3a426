#include "cases/whole_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace chladni::cases {
namespace {

/// A harmonic whose reduced eigenvalues are too large by less than their bounds.
HarmonicPart harmonic(const std::vector<double>& exact, double largest_error, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  HarmonicPart part;
  std::vector<std::array<double, 2>> found;  // lambda and its bound
  for (const double lambda : exact) {
    const double error = largest_error * share(random);
    found.push_back({lambda * (1.0 + error), error * (1.0 + 0.2 * share(random)) + 1e-12});
  }
  // A harmonic by itself bounds place by place; its own values are far enough from each other.
  EXPECT_TRUE(std::ranges::is_sorted(found));
  reduce::Certificate& c = part.certificate;
  for (const auto& [lambda, bound] : found) {
    c.lambda.push_back(lambda);
    c.bounds.push_back(bound);
    c.eta2.push_back(0.5 * bound);
    c.estimates.push_back(0.25 * bound);
    c.rounding.push_back(0.0);
  }
  const auto n = static_cast<int>(exact.size());
  const double sigma = 1.001 * c.lambda.back();
  c.range = c.complete = {.sigma = sigma, .expected = n, .found = n};
  return part;
}

struct Merged {
  std::vector<double> exact;  ///< ascending
  std::vector<HarmonicPart> parts;
};

/// Harmonics with eigenvalues that lie nearer to each other's than their errors.
Merged crossing_harmonics()
{
  Merged all;
  for (unsigned n = 0; n < 4; ++n) {
    std::vector<double> exact;
    for (int i = 0; i < 12; ++i) exact.push_back(100.0 * (i + 1) * (1.0 + 0.013 * n));
    all.exact.insert(all.exact.end(), exact.begin(), exact.end());
    all.parts.push_back(harmonic(exact, 0.05, n + 1));
  }
  std::ranges::sort(all.exact);
  return all;
}

constexpr double everything = std::numeric_limits<double>::infinity();

TEST(WholeCertificate, BoundsEachPlaceAmongAllHarmonics)
{
  const Merged all = crossing_harmonics();
  const mbs_export::Certificate whole = whole_certificate(all.parts, {}, everything);
  ASSERT_GT(whole.bounds.size(), 40);
  bool takes_others = false;  // the bound of a value alone would be one too small at some place
  for (Eigen::Index i = 0; i < whole.bounds.size(); ++i) {
    const double lambda = whole.frequencies[i] * whole.frequencies[i];
    const double error = lambda / all.exact[std::size_t(i)] - 1.0;
    EXPECT_LE(error, whole.bounds[i] + 1e-12) << "place " << i;
    for (const HarmonicPart& part : all.parts) {
      for (std::size_t k = 0; k < part.certificate.lambda.size(); ++k)
        if (std::abs(part.certificate.lambda[k] / lambda - 1.0) < 1e-12)
          takes_others = takes_others || part.certificate.bounds[k] < error;
    }
  }
  EXPECT_TRUE(takes_others);
}

TEST(WholeCertificate, EndsWhereAHarmonicMissesAnEigenvalueOrHasNoBound)
{
  Merged all = crossing_harmonics();
  all.parts[2].certificate.complete.sigma = 650.0;
  const mbs_export::Certificate incomplete = whole_certificate(all.parts, {}, everything);
  ASSERT_GT(incomplete.bounds.size(), 0);
  const double last = incomplete.frequencies[incomplete.bounds.size() - 1];
  EXPECT_LE(last * last, 650.0);
  all.parts[1].certificate.complete.found -= 1;
  EXPECT_EQ(whole_certificate(all.parts, {}, everything).bounds.size(), 0);
}

TEST(WholeCertificate, CountsWhatAllHarmonicsHaveBelowTheLowestOfTheirLimits)
{
  Merged all = crossing_harmonics();
  const double least = 1.0001 * all.parts[0].certificate.lambda[6];
  all.parts[0].certificate.complete = {.sigma = least, .expected = 7, .found = 7};
  const mbs_export::Certificate whole = whole_certificate(all.parts, {}, everything);
  int below = 0;
  for (const HarmonicPart& part : all.parts) {
    below += static_cast<int>(std::ranges::count_if(part.certificate.lambda,
                                                    [&](double lambda) { return lambda < least; }));
  }
  EXPECT_EQ(whole.complete.found, below);
  EXPECT_EQ(whole.complete.expected, below);
  EXPECT_DOUBLE_EQ(whole.complete.up_to, std::sqrt(least));
}

}  // namespace
}  // namespace chladni::cases
