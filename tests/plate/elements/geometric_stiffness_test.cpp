#include "plate/elements/geometric_stiffness.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "elements_under_test.hpp"
#include "plate/elements/beam_element.hpp"
#include "sample_elements.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::steel_like;

constexpr double plate_thickness = 0.05;

/// A flat element in the x-y plane with straight edges, turned by R.
ShellNodes flat(mesh::Shape shape, int order, const Matrix3d& R)
{
  const Eigen::MatrixX2d P = testing::lattice(shape, order);
  ShellNodes nodes{.x = NodeVectors::Zero(P.rows(), 3), .D = NodeVectors::Zero(P.rows(), 3)};
  for (Index k = 0; k < P.rows(); ++k)
    nodes.x.row(k) << P(k, 0) + 0.2 * P(k, 1), 0.8 * P(k, 1) - 0.1 * P(k, 0), 0.0;
  nodes.D.col(2).setConstant(0.5 * plate_thickness);
  return testing::rotated(nodes, R);
}

Matrix3d some_turn()
{
  return Eigen::AngleAxisd(0.7, Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
}

/// u = A (x - x_0) of all nodes, without rotations.
VectorXd linear_field(const NodeVectors& x, const Matrix3d& A)
{
  VectorXd u = VectorXd::Zero(6 * x.rows());
  for (Index i = 0; i < x.rows(); ++i) u.segment<3>(6 * i) = A * x.row(i).transpose();
  return u;
}

class GeometricStiffnessOf : public ::testing::TestWithParam<testing::ElementUnderTest> {};

TEST_P(GeometricStiffnessOf, AUniformlyStretchedElementIsThatOfItsMembraneForces)
{
  const auto [shape, order] = GetParam();
  const Matrix3d R = some_turn();
  const ShellNodes nodes = flat(shape, order, R);
  // e_xx = 2e-3, e_yy = -1e-3, 2 e_xy = 1e-3 in the plane; N by plane stress
  Matrix3d e = Matrix3d::Zero();
  e.topLeftCorner<2, 2>() << 2e-3, 0.5e-3, 0.5e-3, -1e-3;
  const double E = steel_like.young, nu = steel_like.poisson;
  Matrix3d N = (1.0 - nu) * e;
  N.topLeftCorner<2, 2>() += nu * e.trace() * Eigen::Matrix2d::Identity();
  N *= E * plate_thickness / (1.0 - nu * nu);
  const MatrixXd K = shell_geometric_stiffness(shape, order, nodes, steel_like,
                                               linear_field(nodes.x, R * e * R.transpose()));
  // The parallelogram of the corners has the sides (2, -0.2), (0.4, 1.6) or half of them.
  const double area = shape == mesh::Shape::triangle ? 0.5 * 0.82 : 4.0 * 0.82;
  Matrix3d gradient;  // of a displacement in all directions
  gradient << 0.3, 0.5, 0.0, -0.2, 0.7, 0.0, 0.9, -0.4, 0.0;
  const VectorXd v = linear_field(nodes.x, R * gradient * R.transpose());
  const double expected = area * (gradient * N * gradient.transpose()).trace();
  EXPECT_NEAR(v.dot(K * v), expected, 1e-10 * std::abs(expected));  // round-off of strains
  EXPECT_LT((K - K.transpose()).norm(), 1e-14 * K.norm());
}

TEST_P(GeometricStiffnessOf, AStretchedElementCountsTheTurnOfItsSections)
{
  const auto [shape, order] = GetParam();
  const ShellNodes nodes = flat(shape, order, Matrix3d::Identity());
  Matrix3d e = Matrix3d::Zero();
  e(0, 0) = 1e-3;
  const MatrixXd K =
      shell_geometric_stiffness(shape, order, nodes, steel_like, linear_field(nodes.x, e));
  // theta_y = x: u_x = z x, so that int N_xx / t z^2 dV is left; N_yy does not act on it.
  VectorXd v = VectorXd::Zero(6 * nodes.x.rows());
  for (Index i = 0; i < nodes.x.rows(); ++i) v[6 * i + 4] = nodes.x(i, 0);
  const double area = shape == mesh::Shape::triangle ? 0.5 * 0.82 : 4.0 * 0.82;
  const double N = steel_like.young * plate_thickness * 1e-3 / (1.0 - 0.3 * 0.3);
  const double expected = area * N * plate_thickness * plate_thickness / 12.0;
  EXPECT_NEAR(v.dot(K * v), expected, 1e-10 * expected);
}

TEST_P(GeometricStiffnessOf, ACurvedElementDoesNotResistTranslations)
{
  const auto [shape, order] = GetParam();
  const ShellNodes nodes = testing::curved_element(shape, order);
  VectorXd u_e(6 * nodes.x.rows());
  for (Index i = 0; i < u_e.size(); ++i) u_e[i] = 1e-3 * std::sin(1.0 + double(i * i));
  const MatrixXd K = shell_geometric_stiffness(shape, order, nodes, steel_like, u_e);
  const MatrixXd R = testing::rigid_motions(nodes.x);
  EXPECT_GT(K.norm(), 0.0);
  EXPECT_LT((K * R.leftCols(3)).norm(), 1e-12 * K.norm());
}

INSTANTIATE_TEST_SUITE_P(AllElements, GeometricStiffnessOf,
                         ::testing::ValuesIn(testing::elements_under_test()),
                         testing::element_name);

BeamSection section(BeamTheory theory)
{
  return {.group = "beam",
          .material = {.young = 2.1, .poisson = 0.3, .density = 1.7},
          .theory = theory,
          .area = 0.3,
          .I_y = 0.02,
          .I_z = 0.05,
          .J = 0.04,
          .shear_factor_y = 0.8,
          .shear_factor_z = 0.7,
          .orientation = std::array{0.0, 0.0, 1.0}};
}

TEST(BeamGeometricStiffness, IsTheKnownMatrixOfAStringAndThatOfItsSections)
{
  const double l = 1.7, stretch = 1e-3;
  const BeamSection beam = section(BeamTheory::bernoulli_euler);
  NodeVectors x = NodeVectors::Zero(2, 3);
  x(1, 0) = l;
  VectorXd u_e = VectorXd::Zero(12);
  u_e[6] = stretch * l;
  const double N = 2.1 * 0.3 * stretch;
  const MatrixXd K = beam_geometric_stiffness(x, beam, u_e);
  // Przemieniecki's matrix for (w_1, w'_1, w_2, w'_2), and int psi'^2 = K_bending / EI
  Eigen::Matrix4d string, bending;
  string << 36, 3 * l, -36, 3 * l, 3 * l, 4 * l * l, -3 * l, -l * l,  //
      -36, -3 * l, 36, -3 * l, 3 * l, -l * l, -3 * l, 4 * l * l;
  bending << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l,  //
      -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l, 4 * l * l;
  const auto in_plane = [&](double I) -> Eigen::Matrix4d {
    return N / (30.0 * l) * string + N * I / beam.area / (l * l * l) * bending;
  };
  const std::array in_xy{1, 5, 7, 11}, in_xz{2, 4, 8, 10};
  const Eigen::Vector4d turn(1.0, -1.0, 1.0, -1.0);  // theta_y = -w'
  EXPECT_LT((MatrixXd(K(in_xy, in_xy)) - in_plane(beam.I_z)).norm(), 1e-13 * K.norm());
  EXPECT_LT((turn.asDiagonal() * MatrixXd(K(in_xz, in_xz)) * turn.asDiagonal() - in_plane(beam.I_y))
                .norm(),
            1e-13 * K.norm());
  EXPECT_NEAR(K(3, 3), N * (0.02 + 0.05) / 0.3 / l, 1e-14);  // Wagner's term of the twist
  EXPECT_NEAR(K(0, 6), -N / l, 1e-14);
}

TEST(BeamGeometricStiffness, OfARigidRotationIsTheTensionTimesTheLengthWhateverTheTheory)
{
  for (const BeamTheory theory : {BeamTheory::bernoulli_euler, BeamTheory::timoshenko}) {
    const RowVector3d along(0.3, -0.4, 1.2);  // of length 1.3
    NodeVectors x(3, 3);
    x << RowVector3d(0.1, 0.2, 0.3), RowVector3d(0.1, 0.2, 0.3) + 0.3 * along,
        RowVector3d(0.1, 0.2, 0.3) + along;
    BeamSection beam = section(theory);
    beam.orientation = std::array{1.0, 0.0, 0.0};
    const VectorXd u_e = linear_field(x, 1e-3 / along.squaredNorm() * along.transpose() * along);
    const MatrixXd K = beam_geometric_stiffness(x, beam, u_e);
    const double N = 2.1 * 0.3 * 1e-3;
    const Vector3d theta(0.4, 0.1, -0.3);
    const VectorXd v = testing::rigid_motions(x).rightCols(3) * theta;
    const double expected = N * theta.cross(along.transpose()).squaredNorm() / along.norm();
    EXPECT_NEAR(v.dot(K * v), expected, 1e-12 * expected);
  }
}

TEST(ArmGeometricStiffness, IsTheSecondOrderOfTheWorkOnAFiniteRotation)
{
  const Vector3d F(3.0, -1.0, 2.0), r(0.2, 0.5, -0.3), theta(0.3, -0.7, 0.4);
  // F . (R r - r - theta x r) = theta^T G theta / 2, to third order
  const double h = 1e-4;
  const Vector3d end =
      Eigen::AngleAxisd(h * theta.norm(), theta.normalized()).toRotationMatrix() * r;
  const double work = F.dot(end - r - h * theta.cross(r)) / (h * h);
  EXPECT_NEAR(0.5 * theta.dot(arm_geometric_stiffness(F, r) * theta), work, 1e-3);
}

}  // namespace
}  // namespace chladni::plate
