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

TEST(GroupExponents, OfMotionsFarApartOverASlowRotation)
{
  // Over a rotation of 6 s one grows by exp(1500) against the mean, the other decays by as much.
  constexpr double step = 1.0;
  NearGroup group{{0, 1}, true, AngleHarmonics::Zero(4, 8), 1, 0.0};
  group.F.col(0) << Complex(-20.0, 300.0), 0.0, 0.0, Complex(-520.0, 300.0);
  group.F.col(1)[1] = group.F.col(7)[2] = 5.0;
  const GroupExponents found = group_exponents(group, step);
  // Of the second order: 25 / (500 -+ i step).
  Eigen::VectorXd growth = found.lambda.real();
  std::ranges::sort(growth);
  EXPECT_NEAR(growth[0], -520.0 - 25.0 * 500.0 / (500.0 * 500.0 + 1.0), 1e-4);
  EXPECT_NEAR(growth[1], -20.0 + 25.0 * 500.0 / (500.0 * 500.0 + 1.0), 1e-4);
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

/// Three oscillators. The first is coupled weakly to the second and that strongly to the third,
/// with the angle of the rotation: these two resonate with the sixth and seventh harmonic of the
/// first.
TurningModes three_oscillators()
{
  constexpr int N = 64;
  Eigen::VectorXcd lambda(6);
  lambda << Complex(-1.0, 1003.0), Complex(-1.0, -1003.0), Complex(-50.0, 1600.0),
      Complex(-50.0, -1600.0), Complex(-52.0, 1700.0), Complex(-52.0, -1700.0);
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(6, 6);
  C.block<2, 2>(0, 2) << 12.0, 3.0, -2.0, 9.0;
  C.block<2, 2>(2, 0) << 8.0, -4.0, 5.0, 11.0;
  C.block<2, 2>(2, 4) << 80.0, 10.0, -20.0, 70.0;
  C.block<2, 2>(4, 2) << 90.0, -20.0, 10.0, 75.0;
  TurningModes modes{100.0, lambda, Eigen::MatrixXd(36, N), 1, C.reshaped().cast<Complex>()};
  for (int s = 0; s < N; ++s)
    modes.B.col(s) = 2.0 * std::cos(2.0 * std::numbers::pi * s / N) * C.reshaped();
  return modes;
}

/// The eigenvalue of Hill's matrix of all harmonics up to 30 that is nearest to `to`.
Complex by_hills_matrix(const TurningModes& modes, Complex to)
{
  constexpr int K = 30;
  const Eigen::Index m = modes.size(), n = (2 * K + 1) * m;
  const Eigen::MatrixXcd P = from_real_pairs(modes.lambda, Eigen::MatrixXcd::Identity(m, m));
  const Eigen::MatrixXcd C = P * modes.harmonic(1) * P.adjoint();
  Eigen::MatrixXcd A = Eigen::MatrixXcd::Zero(n, n);
  for (int k = -K; k <= K; ++k) {
    const Eigen::Index at = (k + K) * m;
    A.block(at, at, m, m).diagonal() = modes.lambda.array() - Complex(0.0, k * modes.step);
    if (k == K) break;
    A.block(at, at + m, m, m) = C;
    A.block(at + m, at, m, m) = C;
  }
  const Eigen::VectorXcd all = A.eigenvalues();
  Eigen::Index nearest = 0;
  (all.array() - to).abs().minCoeff(&nearest);
  return all[nearest];
}

/// Oscillators of 1003 and 1100 rad/s that drive each other by the first harmonic of 100 rad/s,
/// with c against their damping of 3 1/s, and a third one by itself that grows.
TurningModes driven_beside(double growth, double c)
{
  constexpr int N = 64;
  Eigen::VectorXcd lambda(6);
  lambda << Complex(-3.0, 1003.0), Complex(-3.0, -1003.0), Complex(-3.0, 1100.0),
      Complex(-3.0, -1100.0), Complex(growth, 5000.0), Complex(growth, -5000.0);
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(6, 6);
  C.block<2, 2>(0, 2) = C.block<2, 2>(2, 0) = c * Eigen::Matrix2d::Identity();
  TurningModes modes{100.0, lambda, Eigen::MatrixXd(36, N), 1, C.reshaped().cast<Complex>()};
  for (int s = 0; s < N; ++s)
    modes.B.col(s) = 2.0 * std::cos(2.0 * std::numbers::pi * s / N) * C.reshaped();
  return modes;
}

TEST(NearGroups, ThatMayGrowMostAreThoseOfTheirEquationsAlone)
{
  // In resonance, 1100 - 100 against 1003, one of both grows by sqrt(10^2 - 1.5^2) - 3 = 6.9 1/s.
  for (const double growth : {6.0, 8.0}) {
    const TurningModes modes = driven_beside(growth, 10.0);
    const auto groups = near_groups(modes, 1e-6, GroupsAsked{.least_stable = 1});
    double most = -1e9;
    for (const NearGroup& group : groups) {
      const Eigen::VectorXcd found = group_exponents(group, modes.step).lambda;
      most = std::max(most, found.real().maxCoeff());
    }
    const Complex driven = by_hills_matrix(modes, Complex(6.9, 1001.5));
    EXPECT_NEAR(driven.real(), std::sqrt(100.0 - 2.25) - 3.0, 0.1);
    EXPECT_NEAR(most, std::max(growth, driven.real()), 1e-6) << groups.size();
    EXPECT_EQ(groups.size(), 1u) << "the other one grows less";
  }
}

TEST(NearGroups, StayAloneBesideStatesThatAreNearEachOther)
{
  const TurningModes modes = three_oscillators();
  const auto groups = near_groups(modes, 1e-6);
  const auto is_first = [](const NearGroup& group) { return group.states.front() == 0; };
  const auto first = std::ranges::find_if(groups, is_first);
  ASSERT_NE(first, groups.end());
  EXPECT_EQ(first->states.size(), 1);
  const Complex lambda = group_exponents(*first, modes.step).lambda[0];
  EXPECT_LT(std::abs(lambda - by_hills_matrix(modes, lambda)), 1e-6);
  EXPECT_GT(std::abs(lambda - modes.lambda[0]), 0.01);
}

}  // namespace
}  // namespace chladni::squeal
