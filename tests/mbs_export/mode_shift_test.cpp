#include "mbs_export/held_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "bending_beam.hpp"
#include "common/eigen_every.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::MatrixXd;

TEST(ModeShift, HasTheConditionOfTheRigidModesOfABeam)
{
  const FreeModes modes = orthogonalize(test::regression_beam());
  // Rigid modes 1 and sqrt(12) (x - 1/2). Clamped: Q_dd = [1, -sqrt 3; 0, sqrt 12], so
  // s_1^2 + s_2^2 = 16 and s_1 s_2 = sqrt 12; supported: [1, -sqrt 3; 1, sqrt 3].
  const double sum = std::sqrt(16 + 2 * std::sqrt(12)),
               difference = std::sqrt(16 - 2 * std::sqrt(12));
  const ModeShift clamped = shift_modes(modes, held_dofs(test::regression_beam(), {"A"}));
  EXPECT_NEAR(clamped.condition_Q_dd, (sum + difference) / (sum - difference), 1e-6);  // 4.391067
  EXPECT_EQ(clamped.dependent, (std::vector<int>{0, 1}));
  const ModeShift supported =
      shift_modes(modes, held_dofs(test::regression_beam(), {"A.z", "C.z"}));
  EXPECT_NEAR(supported.condition_Q_dd, std::sqrt(3.0), 1e-7);
  EXPECT_EQ(supported.Q_c.cols(), 104);
}

TEST(ModeShift, HoldsTheHeldDisplacements)
{
  const ReducedSystem wheel = test::wheel();
  const FreeModes modes = orthogonalize(wheel);
  const std::vector<std::vector<std::string>> cases{
      {"hub"}, {"hub.z"}, {"rim.z"}, {"hub", "rim.z"}, {"hub.x", "hub.y", "hub.z"}};
  for (const auto& fixed : cases) {
    const HeldDofs held = held_dofs(wheel, fixed);
    const ModeShift shift = shift_modes(modes, held);
    const MatrixXd displacement = modes.Q_e(held.rows, every) * shift.Q_c;
    // Round-off times cond(Q_dd), which stays below 1e3 here.
    EXPECT_LT(displacement.cwiseAbs().maxCoeff(),
              1e-12 * modes.Q_e(held.rows, every).cwiseAbs().maxCoeff());
    EXPECT_EQ(shift.Q_c.cols(), 78 - Eigen::Index(held.rows.size()));
    EXPECT_LT(shift.condition_Q_dd, 1e6);
  }
}

TEST(ModeShift, LeavesTheRigidMotionsThatNothingHolds)
{
  const ReducedSystem wheel = test::wheel();
  const FreeModes modes = orthogonalize(wheel);
  const auto n_free = [&](const std::vector<std::string>& fixed) {
    return shift_modes(modes, held_dofs(wheel, fixed)).R_c.cols();
  };
  EXPECT_EQ(n_free({}), 6);
  EXPECT_EQ(n_free({"hub.z"}), 5);
  EXPECT_EQ(n_free({"rim.z"}), 3);  // twelve heights hold one translation and two rotations
  EXPECT_EQ(n_free({"hub.x", "hub.y", "hub.z"}), 3);
  EXPECT_EQ(n_free({"hub"}), 0);
}

TEST(ModeShift, DoesNotDependOnTheUnitOfLength)
{
  // The clamped beam with lengths counted in 1e-12 m: cond(Q_dd) grows as much, and costs no
  // digits.
  const ReducedSystem& beam = test::regression_beam();
  ReducedSystem tiny = beam;
  constexpr double unit = 1e-12;
  for (AttachmentNode& node : tiny.attachment_nodes) node.position *= unit;
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(beam.K.rows());
  for (Eigen::Index row = 0; row < beam.n_masters(); ++row)
    if (beam.masters[std::size_t(row)].component >= 3)
      scale[row] = unit;  // w = unit w, theta alike
  tiny.K = scale.asDiagonal() * beam.K * scale.asDiagonal();
  tiny.M = scale.asDiagonal() * beam.M * scale.asDiagonal();
  const auto omega = [](const ReducedSystem& system) {
    const FreeModes modes = orthogonalize(system);
    const ModeShift shift = shift_modes(modes, held_dofs(system, {"A"}));
    return std::tuple{constrained_modes(shift).omega, shift.condition_Q_dd,
                      shift.condition_directions};
  };
  const auto [a, cond_a, directions_a] = omega(beam);
  const auto [b, cond_b, directions_b] = omega(tiny);
  EXPECT_GT(cond_b, 1e11 * cond_a);
  EXPECT_NEAR(directions_b, directions_a, 1e-6 * directions_a);
  EXPECT_LT((b.head(50) - a.head(50)).cwiseQuotient(a.head(50)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(ModeShift, GivesTheSameBodyWhateverModesDepend)
{
  // The clamped beam with its rigid modes as dependent ones, and with elastic ones in their place.
  const ReducedSystem& beam = test::regression_beam();
  const FreeModes modes = orthogonalize(beam);
  const HeldDofs held = held_dofs(beam, {"A"});
  const auto shapes = [&](const ModeShift& shift) {
    const ConstrainedModes constrained = constrained_modes(shift);
    MatrixXd T = (modes.Q_e * (shift.Q_c * constrained.X)).leftCols(20);
    for (Eigen::Index j = 0; j < T.cols(); ++j)
      if (T(4, j) < 0.0) T.col(j) *= -1.0;  // w_C
    return std::pair{Eigen::VectorXd(constrained.omega.head(20)), T};
  };
  const auto [omega, T] = shapes(shift_modes(modes, held));
  for (const std::vector<int>& dependent : {std::vector{0, 2}, {1, 3}, {2, 3}, {4, 7}}) {
    const ModeShift other = shift_modes(modes, held, dependent);
    const auto [omega_other, T_other] = shapes(other);
    // Round-off of K_r, 1e-6 of lambda, which other combinations of modes meet otherwise.
    EXPECT_LT((omega_other - omega).cwiseQuotient(omega).cwiseAbs().maxCoeff(), 2e-8);
    EXPECT_LT((T_other - T).norm(), 1e-6 * T.norm());
    EXPECT_GT(other.condition_directions, 1.0);
  }
}

TEST(ModeShift, RefusesDependentModesThatCannotFollow)
{
  // Elastic modes 1 and 3 of the free beam are both symmetric, so they cannot move the two ends
  // apart: Q_dd is singular.
  const ReducedSystem& beam = test::regression_beam();
  const FreeModes modes = orthogonalize(beam);
  const HeldDofs held = held_dofs(beam, {"A.z", "C.z"});
  const std::string error = files::test::error_of([&] { shift_modes(modes, held, {2, 4}); });
  EXPECT_NE(error.find("cond(Q_dd)"), std::string::npos) << error;
  EXPECT_TRUE(error.find("A.z") != std::string::npos || error.find("C.z") != std::string::npos);
  EXPECT_NE(files::test::error_of([&] { shift_modes(modes, held, {0}); }), "");
}

TEST(ModeShift, RefusesStiffDependentModesThatBuryTheSoftOnesInRounding)
{
  // Of K_c = G^T Lambda_d G + Lambda_i the lowest eigenvalue is a difference of terms of the size
  // of Lambda_d.
  const ReducedSystem& beam = test::regression_beam();
  FreeModes modes = orthogonalize(beam);
  modes.omega.tail(2) *= 1e3;  // as of a part that hardly bends
  const HeldDofs held = held_dofs(beam, {"A"});
  const double softest = modes.omega[modes.n_rigid];
  const auto lost_by = [&](int mode) {
    return std::pow(modes.omega[mode] / softest, 2) * std::numeric_limits<double>::epsilon();
  };
  const int last = static_cast<int>(modes.omega.size()) - 1;
  ASSERT_GT(lost_by(last - 1), 1e-5);
  EXPECT_NE(files::test::error_of([&] {
              shift_modes(modes, held, {last - 1, last});
            }).find("lowest eigenvalues are rounded by"),
            std::string::npos);
  EXPECT_EQ(files::test::error_of([&] { shift_modes(modes, held, {2, 3}); }), "");
}

TEST(ModeShift, RefusesMoreSupportsThanTheModesCanHold)
{
  // Guyan with 6 masters has 6 modes: holding 6 leaves none, a seventh does not exist; a massless
  // rotation drops one mode, so that all six masters cannot be held any more.
  ReducedSystem beam = test::reduced_beam(30, 0);
  beam.M.row(5).setZero();
  beam.M.col(5).setZero();
  const FreeModes modes = orthogonalize(beam);
  EXPECT_EQ(modes.n_massless, 1);
  const std::string error = files::test::error_of([&] {
    shift_modes(modes, held_dofs(beam, {"A", "B", "C"}));
  });
  EXPECT_NE(error.find("cannot hold"), std::string::npos) << error;
}

}  // namespace
}  // namespace chladni::mbs_export
