#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/eigenvalues.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <random>
#include <vector>

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXd;

/// Oscillators with these eigenvalues and their conjugates, in coordinates that mix them.
MatrixXd mixed(const std::vector<Complex>& lambda)
{
  const auto n = 2 * std::ssize(lambda);
  MatrixXd A = MatrixXd::Zero(n, n), mixing(n, n);
  for (Eigen::Index i = 0; i < std::ssize(lambda); ++i) {
    const Complex& one = lambda[static_cast<std::size_t>(i)];
    A.block<2, 2>(2 * i, 2 * i) << one.real(), one.imag(), -one.imag(), one.real();
  }
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (double& entry : mixing.reshaped()) entry = normal(random);
  const Eigen::HouseholderQR<MatrixXd> qr(mixing);
  const MatrixXd Q = linear::columns_of_Q(qr, mixing.rows());
  return Q * A * Q.transpose();
}

/// Two hundred oscillations up to 1e6 1/s: one of them four times, one overdamped in the band, and
/// some that decay or grow almost as fast as the band ends.
std::vector<Complex> known_spectrum()
{
  std::vector<Complex> lambda;
  for (int i = 1; i <= 196; ++i) lambda.emplace_back(-3.0 * i, 130.0 * i * (1.0 + 0.2 * i));
  for (int i = 0; i < 3; ++i) lambda.push_back(lambda[9]);
  lambda.emplace_back(-2.0e4, 4.9e3);
  for (const double frequency : {150.0, 1.99e4})  // in the corners of a band up to 2e4
    for (const double side : {-1.0, 1.0})
      lambda.emplace_back(side * 9.9e3, frequency + 5.0 * side);  // in this order
  return lambda;
}

class LargeMatrix : public testing::TestWithParam<std::vector<Complex>> {};

TEST_P(LargeMatrix, HasAllModesOfTheBandAndNoOthers)
{
  std::vector<Complex> all = known_spectrum();
  all.insert(all.end(), GetParam().begin(), GetParam().end());
  const double highest = 2e4;
  std::vector<Complex> expected;
  for (const Complex& one : all)
    if (one.imag() <= highest) expected.push_back(one);
  std::ranges::sort(expected, {}, [](const Complex& one) { return one.imag(); });
  const MatrixXd A = mixed(all);
  ASSERT_GT(A.rows(), 300);
  const BandModes modes = band_modes(A, highest);
  ASSERT_EQ(modes.lambda.size(), std::ssize(expected));
  ASSERT_GT(expected.size(), 15u);
  for (Eigen::Index i = 0; i < modes.lambda.size(); ++i)
    EXPECT_LT(std::abs(modes.lambda[i] - expected[static_cast<std::size_t>(i)]), 1e-8 * highest);
  const Eigen::MatrixXcd residuals = A * modes.X - modes.X * modes.lambda.asDiagonal();
  EXPECT_LT(residuals.colwise().norm().maxCoeff(), 1e-8 * highest);
  // The four vectors of the eigenvalue of multiplicity four are independent.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> qr(modes.X);
  EXPECT_EQ(qr.rank(), modes.X.cols());
}

// None, and one with a damping ratio of 0.98 and one that grows as fast.
INSTANTIATE_TEST_SUITE_P(WithOthers, LargeMatrix,
                         testing::Values(std::vector<Complex>{},
                                         std::vector<Complex>{{-2.46e4, 5e3}, {3e4, 2e3}}));

TEST(BandModes, OfASmallMatrixAreThoseOfTheQrIteration)
{
  const MatrixXd A = mixed({{-1.0, 10.0}, {2.0, 20.0}, {0.0, 30.0}, {-40.0, 5.0}});
  const BandModes modes = band_modes(A, 25.0);
  ASSERT_EQ(modes.lambda.size(), 3);
  EXPECT_LT(std::abs(modes.lambda[0] - Complex(-40.0, 5.0)), 1e-10);
  EXPECT_LT(std::abs(modes.lambda[1] - Complex(-1.0, 10.0)), 1e-10);
  EXPECT_LT(std::abs(modes.lambda[2] - Complex(2.0, 20.0)), 1e-10);
  EXPECT_EQ(band_modes(A, 1.0).lambda.size(), 0);
}

}  // namespace
}  // namespace chladni::squeal
