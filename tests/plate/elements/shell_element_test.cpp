#include "plate/elements/shell_element.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "common/error.hpp"
#include "sample_elements.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;
using mesh::Shape;
using testing::curved_element;
using testing::rigid_motions;
using testing::steel_like;

class ShellElement : public ::testing::TestWithParam<std::pair<Shape, int>> {
 protected:
  Shape shape() const { return GetParam().first; }
  int order() const { return GetParam().second; }
  ElementMatrices matrices(const ShellNodes& nodes) const
  {
    return shell_matrices(shape(), order(), nodes, steel_like);
  }
};

TEST_P(ShellElement, HasExactlySixZeroModes)
{
  const MatrixXd K = matrices(curved_element(shape(), order())).K;
  const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
  // Round-off leaves 1e-15 of the largest; the softest true mode is drilling at 1e-8 or more.
  EXPECT_LT(lambda.head(6).cwiseAbs().maxCoeff(), 1e-13 * lambda.maxCoeff());
  EXPECT_GT(lambda[6], 1e-9 * lambda.maxCoeff());
}

TEST_P(ShellElement, FeelsNoForceInRigidMotion)
{
  const ShellNodes nodes = curved_element(shape(), order());
  const MatrixXd K = matrices(nodes).K;
  const MatrixXd force = K * rigid_motions(nodes.x);
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-13 * K.cwiseAbs().maxCoeff());
}

TEST_P(ShellElement, TurnsWithTheFrame)
{
  const ShellNodes nodes = curved_element(shape(), order());
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  MatrixXd T = MatrixXd::Zero(6 * nodes.x.rows(), 6 * nodes.x.rows());
  for (Eigen::Index i = 0; i < 2 * nodes.x.rows(); ++i) T.block<3, 3>(3 * i, 3 * i) = R;
  const ElementMatrices here = matrices(nodes);
  const ElementMatrices there = matrices(testing::rotated(nodes, R));
  // Round-off of the rotated coordinates, amplified by the ratio of membrane to bending stiffness.
  EXPECT_LT((T * here.K * T.transpose() - there.K).norm(), 1e-12 * here.K.norm());
  EXPECT_LT((T * here.M * T.transpose() - there.M).norm(), 1e-12 * here.M.norm());
}

/// The numbers of the lattice nodes when the next corner counts as the first one.
std::vector<Eigen::Index> numbers_from_next_corner(Shape shape, int order)
{
  const Eigen::MatrixX2d P = testing::lattice(shape, order);
  std::vector<Eigen::Index> numbers;
  for (const Eigen::RowVector2d& p : P.rowwise()) {
    const Eigen::RowVector2d from = shape == Shape::triangle
                                        ? Eigen::RowVector2d(1.0 - p[0] - p[1], p[0])
                                        : Eigen::RowVector2d(-p[1], p[0]);
    Eigen::Index number = 0;
    (P.rowwise() - from).rowwise().norm().minCoeff(&number);
    numbers.push_back(number);
  }
  return numbers;
}

TEST_P(ShellElement, HasTheSameEnergyWhicheverCornerIsTheFirst)
{
  // Of a thin flat parallelogram or triangle, where the points of a rule, which are not those of
  // the next corner, integrate exactly. A thick one is integrated less, by a part of (t /
  // length)^2.
  const Eigen::MatrixX2d P = testing::lattice(shape(), order());
  ShellNodes nodes{.x = NodeVectors::Zero(P.rows(), 3), .D = NodeVectors::Zero(P.rows(), 3)};
  nodes.x.leftCols<2>() = P * Eigen::Matrix2d{{1.0, 0.2}, {0.3, 0.8}};
  nodes.D.col(2).setConstant(1e-5);
  const std::vector<Eigen::Index> numbers = numbers_from_next_corner(shape(), order());
  const ShellNodes renumbered{.x = nodes.x(numbers, Eigen::all), .D = nodes.D(numbers, Eigen::all)};
  std::vector<Eigen::Index> dofs;
  for (const Eigen::Index number : numbers)
    for (Eigen::Index i = 0; i < 6; ++i) dofs.push_back(6 * number + i);
  const ElementMatrices here = matrices(nodes), there = matrices(renumbered);
  EXPECT_LT((here.K(dofs, dofs) - there.K).norm(), 1e-9 * here.K.norm());
  EXPECT_LT((here.M(dofs, dofs) - there.M).norm(), 1e-12 * here.M.norm());  // round-off
}

TEST_P(ShellElement, HasTheMassAndInertiaOfAFlatPlate)
{
  const Eigen::MatrixX2d P = testing::lattice(shape(), order());
  const double t = 0.3;
  ShellNodes nodes{.x = NodeVectors::Zero(P.rows(), 3), .D = NodeVectors::Zero(P.rows(), 3)};
  nodes.x.leftCols<2>() = P;
  nodes.D.col(2).setConstant(t / 2);
  const MatrixXd R = rigid_motions(nodes.x);
  const MatrixXd m = R.transpose() * matrices(nodes).M * R;
  const bool triangle = shape() == Shape::triangle;
  const double area = triangle ? 0.5 : 4.0;
  const double second_moment = triangle ? 1.0 / 12.0 : 4.0 / 3.0;  // int x^2 dA = int y^2 dA
  const double rho = steel_like.density;
  constexpr double round_off = 1e-12;
  EXPECT_NEAR(m(0, 0), rho * t * area, round_off);
  EXPECT_NEAR(m(3, 3), rho * (t * second_moment + t * t * t / 12.0 * area), round_off);
  EXPECT_NEAR(m(5, 5), rho * t * 2.0 * second_moment, round_off);  // drilling has no mass
}

INSTANTIATE_TEST_SUITE_P(
    ShapesAndOrders, ShellElement,
    ::testing::Values(std::pair{Shape::quadrilateral, 1}, std::pair{Shape::quadrilateral, 2},
                      std::pair{Shape::quadrilateral, 3}, std::pair{Shape::quadrilateral, 4},
                      std::pair{Shape::triangle, 1}, std::pair{Shape::triangle, 2},
                      std::pair{Shape::triangle, 3}));

/// Quadrilaterals that are computed in their plane, where bending and membrane are independent.
class PlaneElement : public ::testing::TestWithParam<int> {};

TEST_P(PlaneElement, IsTheCurvedOneWhereThatIsFlat)
{
  const Eigen::MatrixX2d P = testing::lattice(Shape::quadrilateral, GetParam());
  ShellNodes flat{.x = NodeVectors::Zero(P.rows(), 3), .D = NodeVectors::Zero(P.rows(), 3)};
  for (Eigen::Index k = 0; k < P.rows(); ++k) {
    const double r = P(k, 0), s = P(k, 1);
    flat.x.row(k) << r + 0.1 * s * s + 0.2 * r * s, 0.8 * s + 0.2 * r, 0.0;
  }
  flat.D.col(2).setConstant(0.15);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), R}) {
    const ShellNodes plane = testing::rotated(flat, turn);
    // The least curvature that takes the element out of its plane.
    ShellNodes bent = flat;
    for (Eigen::Index k = 0; k < P.rows(); ++k) bent.x(k, 2) = 1e-9 * P(k, 0) * P(k, 0);
    bent = testing::rotated(bent, turn);
    ASSERT_TRUE(in_its_plane(plane).has_value());
    ASSERT_FALSE(in_its_plane(bent).has_value());
    const ElementMatrices A = shell_matrices(Shape::quadrilateral, GetParam(), plane, steel_like);
    const ElementMatrices B = shell_matrices(Shape::quadrilateral, GetParam(), bent, steel_like);
    EXPECT_LT((A.K - B.K).cwiseAbs().maxCoeff(), 1e-8 * A.K.cwiseAbs().maxCoeff());
    EXPECT_LT((A.M - B.M).cwiseAbs().maxCoeff(), 1e-8 * A.M.cwiseAbs().maxCoeff());
  }
}

TEST_P(PlaneElement, FeelsNoForceInRigidMotion)
{
  // That of drilling is the smallest of all forces: 1e-8 of the largest.
  const Eigen::MatrixX2d P = testing::lattice(Shape::quadrilateral, GetParam());
  ShellNodes flat{.x = NodeVectors::Zero(P.rows(), 3), .D = NodeVectors::Zero(P.rows(), 3)};
  for (Eigen::Index k = 0; k < P.rows(); ++k)
    flat.x.row(k) << P(k, 0) + 0.2 * P(k, 0) * P(k, 1), 0.8 * P(k, 1), 0.0;
  flat.D.col(2).setConstant(0.15);
  const MatrixXd K = shell_matrices(Shape::quadrilateral, GetParam(), flat, steel_like).K;
  EXPECT_LT((K * rigid_motions(flat.x)).cwiseAbs().maxCoeff(), 1e-13 * K.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Orders, PlaneElement, ::testing::Values(2, 3, 4));

/// The field u = sum N_i (u_i + zeta theta_i x D_i) of a shell at a point of a basis, or that of
/// its positions, with its derivatives by the three coordinates.
struct FieldAt {
  Eigen::Vector3d by_xi, by_eta, by_zeta;
};

FieldAt field_at(const Basis& basis, Eigen::Index q, double zeta, const NodeVectors& of_middle,
                 const NodeVectors& of_director)
{
  const NodeVectors at_zeta = of_middle + zeta * of_director;
  return {.by_xi = (basis.N_xi.row(q) * at_zeta).transpose(),
          .by_eta = (basis.N_eta.row(q) * at_zeta).transpose(),
          .by_zeta = (basis.N.row(q) * of_director).transpose()};
}

TEST_P(ShellElement, HasTheCovariantStrainsOfTheLinearPartOfItsMetric)
{
  // eps_ab = (u,a . g_b + u,b . g_a) / 2 and 2 eps_a3 = u,a . g_3 + u,3 . g_a at any height.
  const ShellNodes nodes = curved_element(shape(), order());
  const Basis& basis = rules_of(shape(), order()).full.basis;
  const CovariantStrains strains = covariant_strains(basis, nodes);
  const Eigen::Index n = nodes.x.rows();
  std::srand(11);
  const Eigen::VectorXd u_e = Eigen::VectorXd::Random(6 * n);
  NodeVectors u(n, 3), turned(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d theta = u_e.segment<3>(6 * i + 3), D = nodes.D.row(i).transpose();
    u.row(i) = u_e.segment<3>(6 * i).transpose();
    turned.row(i) = theta.cross(D).transpose();
  }
  for (Eigen::Index q = 0; q < basis.N.rows(); ++q) {
    for (const double zeta : {-0.7, 0.0, 0.5, 1.0}) {
      const FieldAt g = field_at(basis, q, zeta, nodes.x, nodes.D),
                    d = field_at(basis, q, zeta, u, turned);
      const std::array<double, 3> in_plane{d.by_xi.dot(g.by_xi), d.by_eta.dot(g.by_eta),
                                           0.5 * (d.by_xi.dot(g.by_eta) + d.by_eta.dot(g.by_xi))};
      const std::array<double, 2> shear{d.by_xi.dot(g.by_zeta) + d.by_zeta.dot(g.by_xi),
                                        d.by_eta.dot(g.by_zeta) + d.by_zeta.dot(g.by_eta)};
      for (std::size_t r = 0; r < 3; ++r) {
        const double found = strains.m[r].row(q).dot(u_e) + zeta * strains.b[r].row(q).dot(u_e) +
                             zeta * zeta * strains.c[r].row(q).dot(u_e);
        EXPECT_NEAR(found, in_plane[r], 1e-13) << q << " " << zeta << " " << r;
      }
      for (std::size_t r = 0; r < 2; ++r) {
        const double found = strains.g0[r].row(q).dot(u_e) + zeta * strains.g1[r].row(q).dot(u_e);
        EXPECT_NEAR(found, shear[r], 1e-13) << q << " " << zeta << " " << r;
      }
    }
  }
}

/// A circular arc that is bent to another radius without stretch and shear, as sections that stay
/// plane allow: rotation beta = kappa R phi, deflections w = -R^2 kappa (1 - cos phi) outwards and
/// v = R^2 kappa (phi - sin phi) along the arc; eps = kappa R z / (R + z).
/// @return the strain energy of the element over that of the closed form,
///         E kappa^2 R^2 / 2 int z^2 / (R + z) dz of each radian and width
double bent_arc_energy(Shape shape, int order, double R, double thickness)
{
  const Material material{.young = 2.1, .poisson = 0.0, .density = 1.7};
  const double kappa = 1e-3, half_angle = 0.1, half_width = 0.2;
  const Eigen::MatrixX2d P = testing::lattice(shape, order);
  ShellNodes nodes{.x = NodeVectors(P.rows(), 3), .D = NodeVectors(P.rows(), 3)};
  Eigen::VectorXd u = Eigen::VectorXd::Zero(6 * P.rows());
  for (Eigen::Index k = 0; k < P.rows(); ++k) {
    const double phi = half_angle * P(k, 0);
    const Eigen::Vector3d outwards(std::sin(phi), 0.0, std::cos(phi)),
        along(std::cos(phi), 0.0, -std::sin(phi));
    nodes.x.row(k) = (R * outwards + half_width * P(k, 1) * Eigen::Vector3d::UnitY()).transpose();
    nodes.D.row(k) = (0.5 * thickness * outwards).transpose();
    u.segment<3>(6 * k) =
        R * R * kappa * ((std::cos(phi) - 1.0) * outwards + (phi - std::sin(phi)) * along);
    u.segment<3>(6 * k + 3) = kappa * R * phi * Eigen::Vector3d::UnitY();  // outwards to along
  }
  const MatrixXd K = shell_matrices(shape, order, nodes, material).K;
  const double moment = R * R * std::log((R + 0.5 * thickness) / (R - 0.5 * thickness)) -
                        R * thickness;  // int z^2 / (R + z) dz
  const double exact =
      material.young * std::pow(kappa * R, 2) * moment * (2.0 * half_angle) * (2.0 * half_width);
  const double share = shape == Shape::triangle ? 0.125 : 1.0;  // of the square of both
  return u.dot(K * u) / (share * exact);
}

TEST(ShellElement, OfAThickArcHasTheEnergyOfPlaneSections)
{
  // Two points through the thickness leave a part of 7 % of (t / R)^2.
  for (const double t_over_R : {0.1, 0.3, 0.5})
    for (const int order : {3, 4}) {
      EXPECT_NEAR(bent_arc_energy(Shape::quadrilateral, order, 1.0, t_over_R), 1.0,
                  0.1 * t_over_R * t_over_R)
          << t_over_R << " " << order;
    }
}

TEST(ShellElement, OfAThinArcBendsWithoutStretchAndShear)
{
  // The closed form of a thin shell, t / R = 1e-3: where the assumed strains were not those of the
  // points that miss the membrane and shear of interpolated bending, it would be much stiffer.
  for (const int order : {2, 3, 4}) {
    // A parabola through three points of an arc of 0.2 rad misses it by 1e-4 R.
    EXPECT_NEAR(bent_arc_energy(Shape::quadrilateral, order, 1.0, 1e-3), 1.0,
                order == 2 ? 0.15 : 0.02)
        << order;
  }
  for (const int order : {2, 3})
    EXPECT_NEAR(bent_arc_energy(Shape::triangle, order, 1.0, 1e-3), 1.0, 0.05) << order;
}

TEST(ShellElement, RefusesAnOrderThatDoesNotExist)
{
  EXPECT_THROW(check_element_exists(Shape::triangle, 4), Error);
  EXPECT_THROW(check_element_exists(Shape::quadrilateral, 5), Error);
}

}  // namespace
}  // namespace chladni::plate
