#include "plate/elements/shell_resultants.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>

#include "sample_elements.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using mesh::Shape;
using testing::steel_like;

constexpr double shell_thickness = 0.05;
constexpr double E = 2.1, nu = 0.3, G = E / (2 * (1 + nu));  // of steel_like
const double D = E * shell_thickness * shell_thickness * shell_thickness / (12 * (1 - nu * nu));

/// A flat element with straight, distorted edges.
ShellNodes distorted(Shape shape, int order)
{
  const Eigen::MatrixX2d P = testing::lattice(shape, order);
  ShellNodes nodes{.x = NodeVectors::Zero(P.rows(), 3), .D = NodeVectors::Zero(P.rows(), 3)};
  for (Index k = 0; k < P.rows(); ++k) {
    const double r = P(k, 0), s = P(k, 1);
    const double skew = shape == Shape::triangle ? 0.0 : 0.15 * r * s;
    nodes.x.row(k) << r + 0.2 * s + skew, 0.8 * s - 0.1 * r + 0.5 * skew, 0.0;
  }
  nodes.D.col(2).setConstant(shell_thickness / 2);
  return nodes;
}

using Field = std::function<Eigen::Matrix<double, 6, 1>(double x, double y)>;

VectorXd sampled(const ShellNodes& nodes, const Field& field)
{
  VectorXd u_e(6 * nodes.x.rows());
  for (Index i = 0; i < nodes.x.rows(); ++i)
    u_e.segment<6>(6 * i) = field(nodes.x(i, 0), nodes.x(i, 1));
  return u_e;
}

class ShellResultantsOf : public ::testing::TestWithParam<std::pair<Shape, int>> {
 protected:
  ShellResultants of(const ShellNodes& nodes, const Field& field) const
  {
    const auto [shape, order] = GetParam();
    return shell_resultants(shape, order, nodes, steel_like, sampled(nodes, field));
  }
  ShellNodes nodes() const { return distorted(GetParam().first, GetParam().second); }
};

/// Elements of order 1 bend only on average.
class ShellResultantsOfCurvedFields : public ShellResultantsOf {};
/// Shear without moments is no equilibrium: the bubbles of triangles turn and take it away.
class ShellResultantsOfQuadrilaterals : public ShellResultantsOf {};

void expect_rows(const MatrixXd& actual, const Eigen::RowVectorXd& expected, double scale)
{
  ASSERT_GT(actual.rows(), 0);
  for (Index q = 0; q < actual.rows(); ++q) {
    // Round-off of the strains, amplified by length over thickness.
    EXPECT_LT((actual.row(q) - expected).cwiseAbs().maxCoeff(), 1e-12 * scale) << actual;
  }
}

TEST_P(ShellResultantsOf, AConstantMembraneStrainAreExact)
{
  const auto result = of(nodes(), [](double x, double y) {
    return Eigen::Matrix<double, 6, 1>(1e-3 * (x + 0.5 * y), 1e-3 * (y + 0.5 * x), 0, 0, 0, 0);
  });
  const double N = E * shell_thickness / (1 - nu) * 1e-3;
  Eigen::RowVectorXd expected(6);
  expected << N, N, 0.0, G * shell_thickness * 1e-3, 0.0, 0.0;
  expect_rows(result.N, expected, E);
  expect_rows(result.M, Eigen::RowVectorXd::Zero(6), E);
  expect_rows(result.Q, Eigen::RowVectorXd::Zero(3), E);
}

TEST_P(ShellResultantsOfCurvedFields, AConstantCurvatureAreExact)
{
  // w = (x^2 + x y + y^2) / 2 without shear: theta = (w_y, -w_x, 0), u = -z grad w.
  const auto result = of(nodes(), [](double x, double y) {
    const double w_x = x + 0.5 * y, w_y = y + 0.5 * x;
    return Eigen::Matrix<double, 6, 1>(0, 0, 0.5 * (x * x + x * y + y * y), w_y, -w_x, 0);
  });
  Eigen::RowVectorXd expected(6);
  expected << -D * (1 + nu), -D * (1 + nu), 0.0, -D * (1 - nu) * 0.5, 0.0, 0.0;
  expect_rows(result.M, expected, E);
  expect_rows(result.Q, Eigen::RowVectorXd::Zero(3), 10 * E);
  expect_rows(result.N, Eigen::RowVectorXd::Zero(6), E);
}

TEST_P(ShellResultantsOfQuadrilaterals, AConstantShearAreExact)
{
  const auto result = of(nodes(), [](double x, double y) {
    return Eigen::Matrix<double, 6, 1>(0, 0, 1e-3 * x - 2e-3 * y, 0, 0, 0);
  });
  Eigen::RowVectorXd expected(3);
  expected << 1e-3, -2e-3, 0.0;
  expect_rows(result.Q, 5.0 / 6.0 * G * shell_thickness * expected, E);
}

TEST_P(ShellResultantsOf, AnElementTurnWithIt)
{
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  const Field field = [](double x, double y) {
    return Eigen::Matrix<double, 6, 1>(x * y, y, x * x, y, -2 * x, 0.1);
  };
  const auto [shape, order] = GetParam();
  const ShellNodes here = testing::curved_element(shape, order);
  VectorXd u_e = sampled(here, field);
  const ShellResultants before = shell_resultants(shape, order, here, steel_like, u_e);
  for (Index i = 0; i < 2 * here.x.rows(); ++i) u_e.segment<3>(3 * i) = R * u_e.segment<3>(3 * i);
  const ShellResultants after =
      shell_resultants(shape, order, testing::rotated(here, R), steel_like, u_e);
  const auto tensor = [](const MatrixXd& rows) {
    Eigen::Matrix3d A;
    A << rows(0, 0), rows(0, 3), rows(0, 5), rows(0, 3), rows(0, 1), rows(0, 4), rows(0, 5),
        rows(0, 4), rows(0, 2);
    return A;
  };
  EXPECT_LT((R * tensor(before.M) * R.transpose() - tensor(after.M)).norm(), 1e-12 * E);
  EXPECT_LT((R * tensor(before.N) * R.transpose() - tensor(after.N)).norm(), 1e-12 * E);
  EXPECT_LT((R * before.Q.row(0).transpose() - after.Q.row(0).transpose()).norm(), 1e-12 * E);
}

TEST_P(ShellResultantsOf, PointsExtrapolateLinearFieldsToTheNodes)
{
  const auto [shape, order] = GetParam();
  const Points points = resultant_points(shape, order);
  const MatrixXd to_nodes = extrapolation_to_nodes(shape, order);
  const Eigen::MatrixX2d P = testing::lattice(shape, order);
  const double slope = order == 1 ? 0.0 : 3.0;  // one point knows no slope
  const VectorXd values = 2.0 + slope * points.xi.array() - slope * points.eta.array();
  const VectorXd exact = 2.0 + slope * P.col(0).array() - slope * P.col(1).array();
  EXPECT_LT((to_nodes * values - exact).cwiseAbs().maxCoeff(), 1e-12);
}

constexpr auto quadrilateral = Shape::quadrilateral;
constexpr auto triangle = Shape::triangle;
const auto linear = ::testing::Values(std::pair{quadrilateral, 1}, std::pair{triangle, 1});
const auto curved =
    ::testing::Values(std::pair{quadrilateral, 2}, std::pair{quadrilateral, 3},
                      std::pair{quadrilateral, 4}, std::pair{triangle, 2}, std::pair{triangle, 3});

INSTANTIATE_TEST_SUITE_P(Order1, ShellResultantsOf, linear);
INSTANTIATE_TEST_SUITE_P(Order2And3, ShellResultantsOf, curved);
INSTANTIATE_TEST_SUITE_P(Order2And3, ShellResultantsOfCurvedFields, curved);
INSTANTIATE_TEST_SUITE_P(Order1To4, ShellResultantsOfQuadrilaterals,
                         ::testing::Values(std::pair{quadrilateral, 1}, std::pair{quadrilateral, 2},
                                           std::pair{quadrilateral, 3},
                                           std::pair{quadrilateral, 4}));

TEST(ShellResultants, OfACylinderThatGrowsWiderAreTheHoopForce)
{
  // A radial displacement w of a cylinder of radius R: eps = w / R around, N = E t w / R /
  // (1-nu^2).
  const double R = 2.0, w = 1e-3;
  const int order = 3;
  const Eigen::MatrixX2d P = testing::lattice(Shape::quadrilateral, order);
  ShellNodes nodes{.x = NodeVectors(P.rows(), 3), .D = NodeVectors(P.rows(), 3)};
  VectorXd u_e = VectorXd::Zero(6 * P.rows());
  for (Index k = 0; k < P.rows(); ++k) {
    const double phi = 0.1 * P(k, 0);
    const Eigen::RowVector3d radial(std::sin(phi), 0.0, std::cos(phi));
    nodes.x.row(k) = R * radial + 0.3 * P(k, 1) * Eigen::RowVector3d::UnitY();
    nodes.D.row(k) = shell_thickness / 2 * radial;
    u_e.segment<3>(6 * k) = w * radial.transpose();
  }
  const ShellResultants result =
      shell_resultants(Shape::quadrilateral, order, nodes, steel_like, u_e);
  const double N = E * shell_thickness * w / R / (1 - nu * nu);
  for (Index q = 0; q < result.N.rows(); ++q) {
    const double trace = result.N.row(q).head<3>().sum();
    // Cubic arcs of 0.2 rad, and terms of (t / R)^2 = 6e-4 of a thick curved shell.
    EXPECT_NEAR(trace / (N * (1 + nu)), 1.0, 1e-3);
    EXPECT_NEAR(result.N(q, 1) / (N * nu), 1.0, 1e-3);  // along the axis
  }
}

}  // namespace
}  // namespace chladni::plate
