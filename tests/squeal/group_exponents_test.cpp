#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/hill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/error.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

/// y = R(phi) x of x' = J x, where J is lower triangular with ones below its diagonal of -1 and R
/// = 1 + cos(phi) above the diagonal: F = step R' R^-1 + R J R^-1, whose exponents are all -1 with
/// one vector for them.
NearGroup group_of_one_vector(Eigen::Index g, double step)
{
  constexpr Eigen::Index N = 64;
  AngleSamples F(g * g, N);
  const Eigen::MatrixXcd one = Eigen::MatrixXcd::Identity(g, g);
  Eigen::MatrixXcd J = -one, above = Eigen::MatrixXcd::Zero(g, g);
  J.diagonal(-1).setOnes();
  above.diagonal(1).setOnes();
  for (Eigen::Index s = 0; s < N; ++s) {
    const double phi = 2.0 * std::numbers::pi * double(s) / double(N);
    const Eigen::MatrixXcd R = one + std::cos(phi) * above, R_inverse = R.inverse();
    Eigen::Map<Eigen::MatrixXcd>(F.col(s).data(), g, g) =
        (-step * std::sin(phi) * above + R * J) * R_inverse;
  }
  NearGroup group{{}, true, harmonics_of(F), 1, 0.0};
  for (Eigen::Index i = 0; i < g; ++i) group.states.push_back(i);
  return group;
}

TEST(GroupExponents, OfVectorsThatMeetAreWithinTheErrorThatIsTold)
{
  // Where g vectors are one, rounding moves their exponents by its g-th root: they never settle to
  // the 1e-8 1/s at which halving ends, and 2^18 steps would take ten seconds.
  constexpr double step = 10.0;
  for (const Eigen::Index g : {2, 3, 4}) {
    const GroupExponents found = group_exponents(group_of_one_vector(g, step), step);
    const double off = (found.lambda.real().array() + 1.0).abs().maxCoeff();
    EXPECT_LE(off, std::max(found.error, 1e-8)) << g;
    EXPECT_LT(found.error, 10.0 * step * std::pow(1e-16, 1.0 / double(g))) << g;
  }
}

TEST(GroupExponents, AreRefusedWhereTheirStepsWouldFillTheMemory)
{
  // A hundred states of frequencies up to 100 kHz at 2 rad/s: a million steps of 100 x 100 numbers.
  constexpr Eigen::Index g = 100, N = 8;
  AngleSamples F = AngleSamples::Zero(g * g, N);
  NearGroup group{{}, true, F, 1, 0.0};
  for (Eigen::Index i = 0; i < g; ++i) {
    group.states.push_back(i);
    group.F(i * g + i, 0) = Complex(-1.0, 6e3 * double(i));
  }
  try {
    group_exponents(group, 2.0);
    FAIL() << "it takes hours";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("100 states act on each other"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace chladni::squeal
