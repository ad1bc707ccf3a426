#include "linear/dense/eigenmodes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/common/files/scratch_folder.hpp"

namespace chladni::linear {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// Free chain of n unit masses and unit springs: lambda_k = 4 sin^2(k pi / 2 n), k = 0 .. n - 1.
MatrixXd free_chain(int n)
{
  MatrixXd K = MatrixXd::Zero(n, n);
  for (int i = 0; i + 1 < n; ++i) {
    K(i, i) += 1.0;
    K(i + 1, i + 1) += 1.0;
    K(i, i + 1) = K(i + 1, i) = -1.0;
  }
  return K;
}

TEST(Eigenmodes, OfAFreeChainAreItsClosedForm)
{
  const int n = 40;
  const MatrixXd R = VectorXd::Constant(n, 1.0 / std::sqrt(n));
  const Eigenmodes modes = eigenmodes(free_chain(n), MatrixXd::Identity(n, n), R);
  ASSERT_EQ(modes.lambda.size(), n - 1);
  for (int k = 1; k < n; ++k) {
    const double s = std::sin(k * std::numbers::pi / (2 * n));
    // Round-off of mu is eps mu_1: relative to lambda_k, eps lambda_k / lambda_1 < 1e-12.
    EXPECT_NEAR(modes.lambda[k - 1] / (4 * s * s), 1.0, 1e-11);
  }
  EXPECT_LT((R.transpose() * modes.X).norm(), 1e-13);
}

TEST(Eigenmodes, KeepTheLowOnesAccurateBesideStiffOnes)
{
  // lambda spans twelve decades; an eigen-solve of M^-1 K would leave lambda_1 an error of 1e-4.
  const VectorXd lambda =
      VectorXd::LinSpaced(13, 0.0, 12.0).unaryExpr([](double d) { return std::pow(10.0, d); });
  MatrixXd mix = MatrixXd::Identity(13, 13);
  mix.triangularView<Eigen::StrictlyLower>().setConstant(0.1);
  const MatrixXd M = mix.transpose() * mix;
  const MatrixXd K = mix.transpose() * lambda.asDiagonal() * mix;
  const Eigenmodes modes = eigenmodes(K, M, MatrixXd(13, 0));
  // The entries of K hold lambda_1 to eps lambda_max only where columns mix, here in column 1.
  EXPECT_NEAR(modes.lambda[0], 1.0, 1e-4);
  EXPECT_LT((modes.X.transpose() * M * modes.X - MatrixXd::Identity(13, 13)).norm(), 1e-9);
}

TEST(Eigenmodes, LeaveOutMasslessDirections)
{
  const MatrixXd K = VectorXd{{1.0, 4.0, 9.0}}.asDiagonal();
  const MatrixXd M = VectorXd{{1.0, 0.0, 1.0}}.asDiagonal();
  const Eigenmodes modes = eigenmodes(K, M, MatrixXd(3, 0));
  ASSERT_EQ(modes.lambda.size(), 2);
  EXPECT_EQ(modes.n_massless, 1);
  EXPECT_NEAR(modes.lambda[0], 1.0, 1e-14);
  EXPECT_NEAR(modes.lambda[1], 9.0, 1e-13);
}

TEST(Eigenmodes, SeeNoStiffnessToMassRatioWhereTheMassIsRoundOff)
{
  const int n = 5;
  const MatrixXd R = VectorXd::Constant(n + 1, 1.0 / std::sqrt(n));
  MatrixXd M = MatrixXd::Identity(n + 1, n + 1);
  M(n, n) = 1e-31;  // at the end of a last spring, which goes along
  const Eigenmodes modes = eigenmodes(free_chain(n + 1), M, R);
  ASSERT_EQ(modes.lambda.size(), n - 1);
  const double s = std::sin(std::numbers::pi / (2 * n));
  EXPECT_NEAR(modes.lambda[0] / (4 * s * s), 1.0, 1e-12);
}

TEST(Eigenmodes, OfABodyWithOneNodeDoNotSeeTheRoundOffOfItsRigidMotions)
{
  // Two rigid coordinates, in which round-off alone stands in K, and two modes.
  MatrixXd K = VectorXd{{1e-4, 1e-4, 1e4, 4e4}}.asDiagonal();
  K(0, 1) = K(1, 0) = -3e-4;
  MatrixXd M = MatrixXd::Identity(4, 4);
  M(2, 0) = M(0, 2) = 0.6;
  MatrixXd R = MatrixXd::Zero(4, 2);
  R(0, 0) = R(1, 1) = 1.0;
  const Eigenmodes modes = eigenmodes(K, M, R);
  ASSERT_EQ(modes.lambda.size(), 2);
  // The first mode moves against the mass that it is coupled to: 1 - 0.6^2; by the same coupling
  // the projection carries 0.6^2 of the round-off along the first rigid coordinate into its
  // stiffness.
  EXPECT_NEAR(modes.lambda[0], (1e4 + 0.36 * 1e-4) / 0.64, 1e-7);
  EXPECT_NEAR(modes.lambda[1], 4e4, 1e-7);
}

TEST(Eigenmodes, RefuseMechanismsAndNegativeMass)
{
  const MatrixXd I = MatrixXd::Identity(3, 3);
  const MatrixXd K = VectorXd{{1.0, -1.0, 9.0}}.asDiagonal();
  EXPECT_NE(files::test::error_of([&] { eigenmodes(K, I, MatrixXd(3, 0)); }).find("mechanisms"),
            std::string::npos);
  const MatrixXd M = VectorXd{{1.0, -1.0, 1.0}}.asDiagonal();
  EXPECT_NE(files::test::error_of([&] { eigenmodes(I, M, MatrixXd(3, 0)); }).find("semidefinite"),
            std::string::npos);
}

/// Membrane of n x n unit masses and springs with fixed edges: lambda_j + lambda_k of two chains,
/// most of them double.
MatrixXd membrane(int n)
{
  MatrixXd chain = free_chain(n);
  chain(0, 0) = chain(n - 1, n - 1) = 2.0;
  MatrixXd K = MatrixXd::Zero(n * n, n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        K(n * i + j, n * k + j) += chain(i, k);
        K(n * j + i, n * j + k) += chain(i, k);
      }
  return K;
}

/// A point without mass on one bar of direction (cos a, sin a), which is held by three masses in a
/// chain; across the bar a spring and a mass.
struct PointOnBar {
  MatrixXd K = MatrixXd::Zero(5, 5), M = MatrixXd::Zero(5, 5);

  PointOnBar(double a, double spring, double mass)
  {
    VectorXd bar = VectorXd::Zero(5), across = VectorXd::Zero(5);
    bar.head(3) << std::cos(a), std::sin(a), -1.0;
    across.head(2) << -std::sin(a), std::cos(a);
    K = bar * bar.transpose() + spring * across * across.transpose();
    K.bottomRightCorner(3, 3) += free_chain(3);
    K(4, 4) += 1.0;
    M.diagonal() << mass, mass, 1.0, 1.0, 1.0;
  }
};

TEST(Eigenmodes, RefuseAMechanismWithoutMassAtEveryAngle)
{
  const MatrixXd none(5, 0);
  for (int i = 0; i < 200; ++i) {
    const PointOnBar point(0.0157 * i, 0.0, 0.0);
    EXPECT_THROW(eigenmodes(point.K, point.M, none), Error) << 0.0157 * i;
  }
}

/// Of the chain held at its end, with the point along as it moves: omega^2 = 0.19806, ...
TEST(Eigenmodes, OfASoftSupportAreThereWhetherItHasAMassOrNot)
{
  const MatrixXd none(5, 0);
  for (int i = 0; i < 200; ++i) {
    const PointOnBar stiff(0.0157 * i, 1e-6, 0.0), soft(0.0157 * i, 1e-15, 1e-3);
    EXPECT_NEAR(eigenmodes(stiff.K, stiff.M, none).lambda[0], 0.198062264195, 1e-8) << 0.0157 * i;
    const Eigenmodes modes = eigenmodes(soft.K, soft.M, none);
    EXPECT_LT(modes.lambda[0], 1e-11) << 0.0157 * i;
    EXPECT_NEAR(modes.lambda[1], 0.198, 1e-3) << 0.0157 * i;
  }
}

TEST(LowestEigenmodes, AreTheFirstOfAll)
{
  constexpr int n = 15 * 15;
  const MatrixXd K = membrane(15), R(n, 0);
  MatrixXd M = MatrixXd::Identity(n, n);
  for (int i = 0; i < n; i += 7) M(i, i) = 0.0;
  const Eigenmodes all = eigenmodes(K, M, R);
  constexpr double lambda_max = 0.8;
  const auto n_below = (all.lambda.array() <= lambda_max).count();
  ASSERT_GT(n_below, 10);
  const Eigenmodes some = lowest_eigenmodes(K, M, R, {.lambda_max = lambda_max});
  ASSERT_EQ(some.lambda.size(), n_below + 1);
  for (Eigen::Index i = 0; i <= n_below; ++i)
    EXPECT_NEAR(some.lambda[i] / all.lambda[i], 1.0, 1e-12) << i;
  // Of the vectors a residual of 1e-10 leaves as much, over the distance to the next eigenvalue.
  const MatrixXd I = MatrixXd::Identity(n_below + 1, n_below + 1);
  EXPECT_LT((some.X.transpose() * M * some.X - I).norm(), 1e-11);
  EXPECT_LT((K * some.X - M * some.X * some.lambda.asDiagonal()).norm(), 1e-8);
  EXPECT_EQ(lowest_eigenmodes(K, M, R, {.lambda_max = 1e9, .most = 5}).lambda.size(), 5);
  EXPECT_EQ(lowest_eigenmodes(K, M, R, {}).lambda.size(), all.lambda.size());
}

TEST(LowestEigenmodes, LeaveOutTheRigidMotions)
{
  constexpr int n = 220;
  const MatrixXd R = VectorXd::Constant(n, 1.0 / std::sqrt(n));
  const Eigenmodes modes =
      lowest_eigenmodes(free_chain(n), MatrixXd::Identity(n, n), R, {.lambda_max = 0.01});
  for (int k = 1; k <= modes.lambda.size(); ++k) {
    const double s = std::sin(k * std::numbers::pi / (2 * n));
    EXPECT_NEAR(modes.lambda[k - 1] / (4 * s * s), 1.0, 1e-10);
  }
  EXPECT_GT(modes.lambda[modes.lambda.size() - 1], 0.01);
  EXPECT_LT((R.transpose() * modes.X).norm(), 1e-12);
}

/// H A H with a reflection H, which couples all coordinates.
MatrixXd mirrored(const MatrixXd& A)
{
  const VectorXd v = VectorXd::LinSpaced(A.rows(), 1.0, 2.0).normalized();
  const MatrixXd H = MatrixXd::Identity(A.rows(), A.rows()) - 2.0 * v * v.transpose();
  return H * A * H;
}

/// A chain of n masses between fixed ends, one of 2 n masses, and n masses that each have a spring
/// of their own; the coordinates in turn.
MatrixXd decoupled(int n)
{
  MatrixXd K = MatrixXd::Zero(4 * n, 4 * n);
  const auto connect = [&](int a, int b) { K(a, b) = K(b, a) = -1.0; };
  for (int i = 0; i < 4 * n; ++i) K(i, i) = i % 4 == 3 ? 1.0 + i : 2.0;
  for (int i = 0; i + 1 < n; ++i) connect(4 * i, 4 * (i + 1));
  for (int i = 0; i < n; ++i) {
    connect(4 * i + 1, 4 * i + 2);
    if (i + 1 < n) connect(4 * i + 2, 4 * (i + 1) + 1);
  }
  return K;
}

TEST(Eigenmodes, OfDecoupledCoordinatesAreThoseOfAllTogether)
{
  constexpr int n = 30;
  const MatrixXd K = decoupled(n), R(4 * n, 0);
  MatrixXd M = MatrixXd::Identity(4 * n, 4 * n);
  M(3, 3) = M(8, 8) = 0.0;  // a coordinate by itself, and one in a chain
  const Eigenmodes modes = eigenmodes(K, M, R), together = eigenmodes(mirrored(K), mirrored(M), R);
  EXPECT_EQ(modes.n_massless, 2);
  ASSERT_EQ(modes.lambda.size(), together.lambda.size());
  for (Eigen::Index i = 0; i < modes.lambda.size(); ++i)
    EXPECT_NEAR(modes.lambda[i] / together.lambda[i], 1.0, 1e-11) << i;
  const MatrixXd I = MatrixXd::Identity(4 * n - 2, 4 * n - 2);
  EXPECT_LT((modes.X.transpose() * M * modes.X - I).norm(), 1e-12);
  EXPECT_LT((K * modes.X - M * modes.X * modes.lambda.asDiagonal()).norm(), 1e-10);
  for (const int i : {1, 2, 3})
    EXPECT_EQ(modes.X.row(0).cwiseProduct(modes.X.row(i)).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Eigenmodes, BesideARigidMotionOfItsOwnCoordinateAreAllThere)
{
  // Diagonal, as a body is in its modes: frequencies up to 300 MHz beside the rigid motion.
  constexpr int n = 100;
  MatrixXd K = MatrixXd::Zero(n, n);
  for (int i = 1; i < n; ++i) K(i, i) = 1e7 * std::pow(1e11, double(i - 1) / (n - 2));
  const MatrixXd M = MatrixXd::Identity(n, n);
  const Eigenmodes modes = eigenmodes(K, M, M.leftCols(1));
  EXPECT_EQ(modes.n_massless, 0);
  ASSERT_EQ(modes.lambda.size(), n - 1);
  for (int i = 1; i < n; ++i) EXPECT_NEAR(modes.lambda[i - 1] / K(i, i), 1.0, 1e-14) << i;
}

TEST(LowestEigenmodes, OfACoordinateWithAMassOfRoundOffAreNone)
{
  constexpr int n = 60;
  const MatrixXd K = decoupled(n), R(4 * n, 0);
  for (const double mass : {1e-17, -1e-17}) {
    MatrixXd M = MatrixXd::Identity(4 * n, 4 * n);
    M(3, 3) = mass;
    EXPECT_EQ(lowest_eigenmodes(K, M, R, {.lambda_max = 1e9}).lambda.size(), 4 * n - 1);
  }
}

TEST(LowestEigenmodes, OfDecoupledCoordinatesAreTheFirstOfAll)
{
  constexpr int n = 60;
  const MatrixXd K = decoupled(n), M = MatrixXd::Identity(4 * n, 4 * n), R(4 * n, 0);
  const Eigenmodes all = eigenmodes(K, M, R);
  constexpr double lambda_max = 0.1;
  const auto n_below = (all.lambda.array() <= lambda_max).count();
  const Eigenmodes some = lowest_eigenmodes(K, M, R, {.lambda_max = lambda_max});
  ASSERT_EQ(some.lambda.size(), n_below + 1);
  for (Eigen::Index i = 0; i <= n_below; ++i)
    EXPECT_NEAR(some.lambda[i] / all.lambda[i], 1.0, 1e-11) << i;
  EXPECT_LT((K * some.X - some.X * some.lambda.asDiagonal()).norm(), 1e-8);
  EXPECT_EQ(lowest_eigenmodes(K, M, R, {.lambda_max = 1e9, .most = 5}).lambda.size(), 5);
}

TEST(LowestEigenmodes, MissNoneOfMoreEqualOnesThanABlockHas)
{
  // Twelve equal chains: a block of eight sees eight of each.
  constexpr int n_chains = 12, n = 20;
  MatrixXd chain = free_chain(n);
  chain(0, 0) = 2.0;
  MatrixXd K = MatrixXd::Zero(n_chains * n, n_chains * n);
  for (int i = 0; i < n_chains; ++i) K.block(i * n, i * n, n, n) = chain;
  K = mirrored(K);  // or each would be solved by itself
  const Eigenmodes modes = lowest_eigenmodes(K, MatrixXd::Identity(n_chains * n, n_chains * n),
                                             MatrixXd(n_chains * n, 0), {.lambda_max = 0.02});
  ASSERT_GE(modes.lambda.size(), n_chains);
  EXPECT_NEAR(modes.lambda[n_chains - 1] / modes.lambda[0], 1.0, 1e-10);
}

TEST(FirstEigenvalue, IsThatOfTheFirstElasticModeOfAFreeChainFromAbove)
{
  for (const int n : {2, 5, 40}) {
    const MatrixXd R = VectorXd::Constant(n, 1.0 / std::sqrt(n));
    const double exact = std::pow(2.0 * std::sin(std::numbers::pi / (2 * n)), 2);
    const double found = first_eigenvalue(free_chain(n), MatrixXd::Identity(n, n), R);
    EXPECT_GE(found, exact * (1.0 - 1e-12)) << n;
    EXPECT_LE(found, exact * 1.01) << n;
  }
}

TEST(FirstEigenvalue, IsNoneOfABodyThatDoesNotBend)
{
  const MatrixXd one = MatrixXd::Identity(1, 1);
  EXPECT_EQ(first_eigenvalue(0.0 * one, one, one), 0.0);
}

}  // namespace
}  // namespace chladni::linear
