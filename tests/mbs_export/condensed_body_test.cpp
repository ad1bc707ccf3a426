#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/make_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <random>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/check_body.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

ModalBody wheel_on_hub()
{
  BodyOptions options;
  options.fixed = {"hub"};
  options.keep.count = 12;
  options.damping = {.type = Damping::Type::modal, .ratios = {0.01}};
  return make_body(test::wheel(), options);
}

MatrixXd random_shapes(Index n, Index k)
{
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  MatrixXd shapes(n, k);
  for (double& entry : shapes.reshaped()) entry = normal(random);
  return shapes;
}

TEST(CondensedBody, OfSomeOfItsModesHasTheseModes)
{
  const ModalBody body = wheel_on_hub();
  const std::vector<int> kept{1, 4, 5};
  MatrixXd shapes = MatrixXd::Zero(body.n_modes(), 4);
  for (Index j = 0; j < 3; ++j) shapes(kept[static_cast<std::size_t>(j)], j) = 2.0 + double(j);
  shapes.col(3) = shapes.col(0) + shapes.col(1);  // depends on others
  const ModalBody few = condensed(body, shapes);
  ASSERT_EQ(few.n_modes(), 3);
  EXPECT_LT((few.omega - body.omega(kept)).cwiseAbs().maxCoeff(), 1e-10 * body.omega[5]);
  EXPECT_EQ(std::ranges::count(few.kinds, ModeKind::constrained), 3);
  // The motions that the modes allow are the same, whatever their signs.
  const MatrixXd Phi = body.attachment_modes(every, kept), Psi = few.attachment_modes;
  EXPECT_LT((Psi * Psi.transpose() - Phi * Phi.transpose()).norm(), 1e-10 * Phi.squaredNorm());
}

TEST(CondensedBody, HasTheResponseOfItsShapesToForces)
{
  const ModalBody body = wheel_on_hub();
  const MatrixXd shapes = random_shapes(body.n_modes(), 5);
  const ModalBody few = condensed(body, shapes);
  ASSERT_EQ(few.n_modes(), 5);
  for (Index j = 0; j < 5; ++j) EXPECT_GE(few.omega[j], body.omega[j] * (1.0 - 1e-12));
  EXPECT_GT(std::ranges::count(few.kinds, ModeKind::interface), 0);
  // Phi (K + i Omega C - Omega^2)^-1 Phi^T of both, the large one on the shapes by hand.
  const double Omega = 0.7 * body.omega[3];
  const auto dynamic = [Omega](const ModalBody& one) {
    Eigen::MatrixXcd D = (std::complex<double>(0.0, Omega) * one.C).eval();
    D.diagonal().array() += one.omega.array().square() - Omega * Omega;
    return D;
  };
  const Eigen::MatrixXcd on_shapes = shapes.transpose() * dynamic(body) * shapes;
  const MatrixXd Phi = body.attachment_modes * shapes;
  const Eigen::MatrixXcd expected = Phi * on_shapes.inverse() * Phi.transpose();
  const Eigen::MatrixXcd found =
      few.attachment_modes * dynamic(few).inverse() * few.attachment_modes.transpose();
  EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm());
  // Rings and the picture are motions of the same space.
  for (std::size_t i = 0; i < body.rings.size(); ++i) {
    const MatrixXd W = body.rings[i].W * shapes;
    const MatrixXd rest = few.rings[i].W - W * W.colPivHouseholderQr().solve(few.rings[i].W);
    EXPECT_LT(rest.norm(), 1e-9 * W.norm());
  }
}

TEST(CondensedBody, IsASoundBody)
{
  const ModalBody body = wheel_on_hub();
  const ModalBody few = condensed(body, random_shapes(body.n_modes(), 6));
  for (const Check& check : check_body(few))
    EXPECT_NE(check.verdict, Verdict::fail) << check.name << ": " << check.value;
}

TEST(CondensedBody, RefusesNoShapes)
{
  const ModalBody body = wheel_on_hub();
  EXPECT_THROW(condensed(body, MatrixXd::Zero(body.n_modes(), 2)), Error);
  EXPECT_THROW(condensed(body, MatrixXd::Identity(body.n_modes() + 1, 2)), Error);
}

}  // namespace
}  // namespace chladni::mbs_export
