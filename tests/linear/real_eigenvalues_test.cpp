#include "linear/dense/eigenmodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::linear {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

/// Largest distance of one of them to the nearest of the others, both ways.
double distance(const VectorXcd& a, const VectorXcd& b)
{
  double largest = 0.0;
  for (const Complex& one : a) largest = std::max(largest, (b.array() - one).abs().minCoeff());
  for (const Complex& one : b) largest = std::max(largest, (a.array() - one).abs().minCoeff());
  return largest;
}

MatrixXd random_matrix(Index n)
{
  std::mt19937 random(static_cast<unsigned>(n));
  std::normal_distribution<double> value;
  return MatrixXd::NullaryExpr(n, n, [&] { return value(random); });
}

/// Q D Q^T with an orthogonal Q has the condition number of D, by rotations and by a bidiagonal
/// form.
TEST(ConditionNumber, IsThatOfADiagonalBetweenRotations)
{
  for (const Index n : {Index{5}, Index{100}}) {
    const MatrixXd Q = columns_of_Q(Eigen::HouseholderQR<MatrixXd>(random_matrix(n)), n);
    const Eigen::VectorXd d =
        Eigen::VectorXd::LinSpaced(n, 0.0, 6.0).unaryExpr([](double exponent) {
          return std::pow(10.0, -exponent);
        });
    EXPECT_NEAR(condition_number(Q * d.asDiagonal() * Q.transpose()), 1e6, 1e-1);  // eps cond^2
  }
  EXPECT_EQ(condition_number(MatrixXd()), 1.0);
  EXPECT_EQ(condition_number(MatrixXd::Zero(3, 3)), std::numeric_limits<double>::infinity());
}

TEST(RealEigenvalues, AreThoseOfEigenAndOfTheSum)
{
  for (const Index n : {1, 2, 3, 4, 5, 8, 33, 120}) {
    const MatrixXd A = random_matrix(n);
    const VectorXcd found = real_eigenvalues(A);
    ASSERT_EQ(found.size(), n);
    const Eigen::EigenSolver<MatrixXd> reference(A, false);
    EXPECT_LE(distance(found, reference.eigenvalues()), 1e-12 * A.norm()) << n;
    EXPECT_NEAR(found.sum().real(), A.trace(), 1e-12 * A.norm()) << n;
    EXPECT_EQ(found.sum().imag(), 0.0) << n;
  }
  EXPECT_EQ(real_eigenvalues(MatrixXd()).size(), 0);
}

TEST(RealEigenvalues, OfAPairStandTogetherWithTheUpperFirst)
{
  const VectorXcd found = real_eigenvalues(random_matrix(60));
  for (Index i = 0; i < found.size(); ++i) {
    if (found[i].imag() == 0.0) continue;
    EXPECT_GT(found[i].imag(), 0.0);
    ASSERT_LT(i + 1, found.size());
    EXPECT_EQ(found[i + 1], std::conj(found[i]));
    ++i;
  }
}

/// Its eigenvalues all have the modulus 1: no shift by those of the last two rows moves it.
TEST(RealEigenvalues, OfAPermutationAreRootsOfUnity)
{
  for (const Index n : {3, 4, 7, 32}) {
    MatrixXd A = MatrixXd::Zero(n, n);
    A(0, n - 1) = 1.0;
    A.diagonal(-1).setOnes();
    VectorXcd roots(n);
    for (Index k = 0; k < n; ++k)
      roots[k] = std::polar(1.0, 2.0 * std::numbers::pi * double(k) / double(n));
    EXPECT_LE(distance(real_eigenvalues(A), roots), 1e-13) << n;
  }
}

/// What its reduction leaves is of all sizes down to 1e-190.
TEST(RealEigenvalues, OfRankOneAreItsTraceAndZeros)
{
  const Index n = 60;
  VectorXcd exact = VectorXcd::Zero(n);
  exact[0] = double(n);
  EXPECT_LE(distance(real_eigenvalues(MatrixXd::Ones(n, n)), exact), 1e-12);
  EXPECT_EQ(real_eigenvalues(MatrixXd::Zero(n, n)), VectorXcd::Zero(n));
}

/// A triple eigenvalue with one eigenvector: half and third powers of rounding.
TEST(RealEigenvalues, WithoutTheirOwnEigenvectorsAreNearEachOther)
{
  const Index n = 3;
  MatrixXd A = 2.0 * MatrixXd::Identity(n, n);
  A.diagonal(1).setOnes();
  const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(random_matrix(n)).householderQ();
  EXPECT_LE(distance(real_eigenvalues(Q * A * Q.transpose()), VectorXcd::Constant(n, 2.0)), 3e-5);
}

TEST(RealEigenvalues, OfSlightlyDampedMotionsKeepTheirGrowth)
{
  const Index n = 40;
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
  VectorXcd exact(2 * n);
  for (Index i = 0; i < n; ++i) {
    const double omega = 100.0 * double(i + 1), growth = -1e-3 * double(i % 3);
    A(2 * i, 2 * i) = A(2 * i + 1, 2 * i + 1) = growth;
    A(2 * i, 2 * i + 1) = omega;
    A(2 * i + 1, 2 * i) = -omega;
    exact[2 * i] = {growth, omega};
    exact[2 * i + 1] = {growth, -omega};
  }
  const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(random_matrix(2 * n)).householderQ();
  EXPECT_LE(distance(real_eigenvalues(Q * A * Q.transpose()), exact), 1e-10);
}

TEST(RealEigenvalues, OfWhatIsNotFiniteAreAnError)
{
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const Index n : {1, 2, 6}) {
      MatrixXd A = MatrixXd::Identity(n, n);
      A(0, n - 1) = bad;
      EXPECT_THROW(real_eigenvalues(A), Error) << n;
    }
  }
}

TEST(RealEigenvalues, OfLargeAndSmallMatricesAreThoseTimesTheirSize)
{
  for (const Index n : {2, 3, 9}) {
    const MatrixXd A = random_matrix(n);
    const VectorXcd usual = real_eigenvalues(A);
    for (const int power : {-600, 600}) {
      const VectorXcd found = real_eigenvalues(std::scalbn(1.0, power) * A);
      EXPECT_EQ(VectorXcd(std::scalbn(1.0, -power) * found), usual) << n << " " << power;
    }
  }
}

}  // namespace
}  // namespace chladni::linear
