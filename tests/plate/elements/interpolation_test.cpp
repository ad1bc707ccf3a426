#include "plate/elements/interpolation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace chladni::plate {
namespace {

using mesh::Shape;

constexpr double round_off = 1e-13;  // sums of some ten terms of order one

double integral(const Points& points, int i, int j)
{
  return (points.weight.array() * points.xi.array().pow(i) * points.eta.array().pow(j)).sum();
}

double factorial(int n)
{
  return std::tgamma(n + 1.0);
}

TEST(GaussPoints, IntegrateMonomialsOnTheTriangleExactly)
{
  for (int n = 1; n <= 5; ++n) {
    for (int i = 0; i <= 2 * n - 2; ++i) {
      for (int j = 0; i + j <= 2 * n - 2; ++j) {
        const double exact = factorial(i) * factorial(j) / factorial(i + j + 2);
        EXPECT_NEAR(integral(gauss_points(Shape::triangle, n), i, j), exact, round_off);
      }
    }
  }
}

TEST(GaussPoints, IntegrateMonomialsOnTheQuadrilateralExactly)
{
  const auto exact = [](int i) { return i % 2 ? 0.0 : 2.0 / (i + 1); };
  for (int n = 1; n <= 5; ++n) {
    for (int i = 0; i < 2 * n; ++i) {
      for (int j = 0; j < 2 * n; ++j) {
        EXPECT_NEAR(integral(gauss_points(Shape::quadrilateral, n), i, j), exact(i) * exact(j),
                    round_off);
      }
    }
  }
}

TEST(GaussLobatto, HasTheKnownInnerPoints)
{
  EXPECT_NEAR(gauss_lobatto(4)[2], std::sqrt(1.0 / 5.0), round_off);
  EXPECT_NEAR(gauss_lobatto(5)[3], std::sqrt(3.0 / 7.0), round_off);
  EXPECT_NEAR(gauss_lobatto(3)[1], 0.0, round_off);
}

class BasisOf : public ::testing::TestWithParam<std::pair<Shape, int>> {};

TEST_P(BasisOf, ReproducesPolynomialsOfItsOrderAndTheirDerivatives)
{
  const auto [shape, order] = GetParam();
  const Points points = gauss_points(shape, 4);
  const Basis basis = lagrange_basis(shape, order, points);
  // Nodal coordinates follow from the basis' own linear completeness only at the nodes; take them
  // from the lattice.
  const Eigen::Index n = basis.N.cols();
  Eigen::VectorXd values(n);
  Eigen::Index k = 0;
  for (int j = 0; j <= order; ++j) {
    for (int i = 0; i <= (shape == Shape::triangle ? order - j : order); ++i, ++k) {
      const double scale = shape == Shape::triangle ? 1.0 : 2.0;
      const double offset = shape == Shape::triangle ? 0.0 : -1.0;
      const double x = offset + scale * i / order;
      const double y = offset + scale * j / order;
      values[k] = std::pow(x, order) + 2.0 * std::pow(y, order - 1) * x;
    }
  }
  for (Eigen::Index q = 0; q < points.size(); ++q) {
    const double x = points.xi[q];
    const double y = points.eta[q];
    EXPECT_NEAR(basis.N.row(q).dot(values), std::pow(x, order) + 2.0 * std::pow(y, order - 1) * x,
                round_off);
    EXPECT_NEAR(basis.N_xi.row(q).dot(values),
                order * std::pow(x, order - 1) + 2.0 * std::pow(y, order - 1), 10 * round_off);
  }
}

INSTANTIATE_TEST_SUITE_P(
    ShapesAndOrders, BasisOf,
    ::testing::Values(std::pair{Shape::quadrilateral, 1}, std::pair{Shape::quadrilateral, 2},
                      std::pair{Shape::quadrilateral, 3}, std::pair{Shape::quadrilateral, 4},
                      std::pair{Shape::triangle, 1}, std::pair{Shape::triangle, 2},
                      std::pair{Shape::triangle, 3}));

}  // namespace
}  // namespace chladni::plate
