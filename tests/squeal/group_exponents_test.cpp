#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/hill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace
}  // namespace chladni::squeal
