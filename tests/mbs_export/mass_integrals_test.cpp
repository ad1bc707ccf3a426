#include "mbs_export/inertia.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "mbs_export/free_modes.hpp"
#include "mbs_export/make_body.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d;

const Vector3d axis = Vector3d(1.0, -2.0, 2.0) / 3.0;

TEST(GyroscopicMatrix, OfAWheelIsThatOfItsPointMasses)
{
  const ReducedSystem wheel = test::wheel();
  const MatrixXd G = gyroscopic_matrix(*wheel.mass_integrals, axis);
  MatrixXd exact = MatrixXd::Zero(G.rows(), G.cols());
  for (Index node = 0; node < G.rows(); node += 6) {
    const double m = wheel.M(node, node), J = wheel.M(node + 3, node + 3);
    for (Index i = 0; i < 3; ++i) {
      for (Index j = 0; j < 3; ++j) {
        const double triple = Vector3d::Unit(i).dot(axis.cross(Vector3d::Unit(j)));
        exact(node + i, node + j) = 2.0 * m * triple;
        // 2 int (e_i x r) . (e x (e_j x r)) dm with int r r^T dm = J / 2
        exact(node + 3 + i, node + 3 + j) = J * triple;
      }
    }
  }
  EXPECT_LT((G - exact).norm(), 1e-15);
}

TEST(GyroscopicMatrix, TurnsTheImpulseOfARigidMotion)
{
  // int phi_i . (e x u) dm for a translation u is e x u times the mass: what a spin does to all of
  // the body at once.
  const ReducedSystem wheel = test::wheel();
  const auto R = rigid_body_vectors(wheel, Vector3d::Zero());
  const MatrixXd G = R.transpose() * gyroscopic_matrix(*wheel.mass_integrals, axis) * R;
  const double mass = wheel.mass_integrals->mass;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) {
      EXPECT_NEAR(G(i, j), 2.0 * mass * Vector3d::Unit(i).dot(axis.cross(Vector3d::Unit(j))),
                  1e-14);
    }
  // Rotations about x and y, spin about z: 2 int (e_x x X) . (e_z x (e_y x X)) = -2 int z^2 dm
  const MatrixXd G_z =
      R.transpose() * gyroscopic_matrix(*wheel.mass_integrals, Vector3d::UnitZ()) * R;
  EXPECT_NEAR(G_z(3, 4), -2.0 * wheel.mass_integrals->second(2, 2), 1e-15);
}

TEST(MassIntegrals, GoWithTheModesOfABody)
{
  const ModalBody body = make_body(test::wheel(), {});
  ASSERT_TRUE(body.mass_integrals);
  const auto& S = body.mass_integrals->products;
  const MatrixXd M = S[0] + S[1] + S[2];
  // Modes of unit mass; round-off of products of 78 rows.
  EXPECT_LT((M - MatrixXd::Identity(M.rows(), M.cols())).cwiseAbs().maxCoeff(), 1e-12);
  const MatrixXd G = gyroscopic_matrix(*body.mass_integrals, axis);
  EXPECT_LT((G + G.transpose()).norm(), 1e-15 * G.norm());
  // Elastic modes of a free body carry no momentum.
  EXPECT_LT(body.mass_integrals->displacement.rightCols(72).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace chladni::mbs_export
