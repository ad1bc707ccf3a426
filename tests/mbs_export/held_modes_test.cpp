#include "mbs_export/held_modes.hpp"

#include <gtest/gtest.h>

#include "bending_beam.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::MatrixXd;

/// By the free modes under the constraints, the other way to the same modes.
void expect_the_modes_of_a_mode_shift(const ReducedSystem& reduced,
                                      const std::vector<std::string>& fixed)
{
  const HeldModeShapes held = held_mode_shapes(reduced, fixed);
  const FreeModes free = orthogonalize(reduced);
  const ConstrainedModes shifted = constrained_modes(shift_modes(free, held_dofs(reduced, fixed)));
  EXPECT_EQ(held.n_rigid, shifted.n_rigid);
  EXPECT_EQ(held.n_free_rigid, free.n_rigid);
  ASSERT_EQ(held.omega.size(), shifted.omega.size() - shifted.n_rigid);
  for (Eigen::Index i = 0; i < held.omega.size(); ++i)
    EXPECT_NEAR(held.omega[i] / shifted.omega[shifted.n_rigid + i], 1.0, 1e-9) << i;
  const MatrixXd I = MatrixXd::Identity(held.X.cols(), held.X.cols());
  EXPECT_LT((held.X.transpose() * reduced.M * held.X - I).norm(), 1e-11);
  EXPECT_EQ(held_dofs(reduced, fixed).displacements(held.X).norm(), 0.0);
}

TEST(HeldModes, AreThoseOfAModeShift)
{
  for (const std::vector<std::string>& fixed :
       {std::vector<std::string>{}, {"hub"}, {"hub.z"}, {"rim.z"}, {"hub", "rim.z"}})
    expect_the_modes_of_a_mode_shift(test::wheel(), fixed);
  for (const std::vector<std::string>& fixed :
       {std::vector<std::string>{}, {"A"}, {"A.z", "C.z"}, {"B.ry"}})
    expect_the_modes_of_a_mode_shift(test::reduced_beam(60, 8), fixed);
}

TEST(HeldModes, HaveTheResidualOfTheFreeRigidMotions)
{
  const ReducedSystem wheel = test::wheel();
  const double exact = orthogonalize(wheel).rigid_residual;
  EXPECT_NEAR(rigid_residual(wheel), exact, 0.05 * exact);
}

TEST(FirstEigenvalue, IsTheFirstOfAll)
{
  const ReducedSystem beam = test::reduced_beam(60, 8);
  const MatrixXd R = rigid_modes(beam).R;
  ASSERT_EQ(R.cols(), 2);
  const double first = linear::eigenmodes(beam.K, beam.M, R).lambda[0];
  EXPECT_NEAR(linear::first_eigenvalue(beam.K, beam.M, R) / first, 1.0, 1e-6);
  EXPECT_EQ(
      linear::first_eigenvalue(MatrixXd::Zero(1, 1), MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1)),
      0.0);
}

}  // namespace
}  // namespace chladni::mbs_export
