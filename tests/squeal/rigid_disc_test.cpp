#include "squeal/models/rigid_disc.hpp"
#include "squeal/stability/stability.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "source_disc.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;
using test::source_disc;

const SpeedRange speeds{.from = pi, .to = 20.0 * pi, .count = 60};

/// SQUEAL reference values at q = (-0.005, 0.004), q' = (20, 35), 6 pi: a numpy program that shares
/// nothing with this one. 12 digits, rounding of a 3 x 3 solution.
struct Reference {
  ContactLaw law;
  double N_lower, q_ddot_1, q_ddot_2, moment, q_ddot_1_free, q_ddot_2_free, spin_rate_free;
};
const Reference references[] = {
    {ContactLaw::signed_force, -883.4703261619009, 592453.2064001065, -469604.26734382217,
     1450.8793639998594, 592477.7782081072, -469573.5524916761, -3071.5333341801065},
    {ContactLaw::bilateral, -888.1788224161496, 592447.6733410066, -469542.3929893004,
     1588.4670417065697, 592475.6848162989, -469507.37854014104, -3501.4997714942283},
    {ContactLaw::unilateral, 0.0, 591731.004932974, -469573.6050656989, 1518.5694675227705,
     591757.2689814349, -469540.77490663156, -3283.067340264656}};
const RigidMotion<double> large_motion{{-0.005, 0.004}, {20.0, 35.0}, 6.0 * pi};

TEST(RigidDisc, AcceleratesLikeTheReferenceForEachContactLawAndDrive)
{
  for (const Reference& reference : references) {
    SCOPED_TRACE(static_cast<int>(reference.law));
    const RigidDisc disc = source_disc(reference.law);
    const auto driven = accelerate(disc, large_motion, Drive::speed);
    EXPECT_NEAR(driven.q_ddot[0], reference.q_ddot_1, 1e-11 * 6e5);
    EXPECT_NEAR(driven.q_ddot[1], reference.q_ddot_2, 1e-11 * 6e5);
    EXPECT_NEAR(driven.moment, reference.moment, 1e-11 * 1.5e3);
    EXPECT_EQ(driven.spin_rate, 0.0);
    const auto free = accelerate(disc, large_motion, Drive::moment);
    EXPECT_NEAR(free.q_ddot[0], reference.q_ddot_1_free, 1e-11 * 6e5);
    EXPECT_NEAR(free.q_ddot[1], reference.q_ddot_2_free, 1e-11 * 6e5);
    EXPECT_NEAR(free.spin_rate, reference.spin_rate_free, 1e-11 * 6e5);
    EXPECT_DOUBLE_EQ(free.moment, 2.0 * 0.6 * 0.13 * 3000.0);
  }
}

TEST(RigidDisc, PressesThePadsLikeTheReference)
{
  for (const Reference& reference : references) {
    const auto a = accelerate(source_disc(reference.law), large_motion, Drive::speed);
    EXPECT_NEAR(a.upper.z, 0.010650210419556284, 1e-16);  // rounding of 1e-2
    EXPECT_NEAR(a.upper.z_dot, -2.599664993749955, 1e-13);
    EXPECT_NEAR(a.upper.slip_speed, 2.809564075877993, 1e-13);
    EXPECT_NEAR(a.lower.slip_speed, 2.1079031581937215, 1e-13);
    EXPECT_NEAR(a.upper.N, 6903.349848926033, 1e-8);
    EXPECT_NEAR(a.lower.N, reference.N_lower, 1e-8);
    // Vertical equilibrium of the massless pads.
    EXPECT_NEAR(a.upper.F[2], -a.upper.S, 1e-11 * a.upper.S);
    EXPECT_NEAR(a.lower.F[2], a.lower.S, 1e-11 * a.upper.S);
  }
}

TEST(RigidDisc, HasTheMatricesThatItsLinearisationGives)
{
  // Both drives, all laws, several speeds: rounding of the largest entry of each matrix.
  for (const Drive drive : {Drive::speed, Drive::moment})
    for (const Reference& reference : references)
      for (const double speed : {pi, 6.0 * pi, 20.0 * pi}) {
        const RigidDisc disc = source_disc(reference.law);
        const RigidMatrices closed = rigid_disc_matrices(disc, speed);
        const RigidMatrices numerical = linearised(disc, drive, speed);
        // The stiffness is a difference of moments of 1e3 N m and more, each rounded: 1e-12.
        EXPECT_LT((closed.C - numerical.C).cwiseAbs().maxCoeff(), 1e-13 * closed.C.norm());
        EXPECT_LT((closed.K - numerical.K).cwiseAbs().maxCoeff(), 1e-14 * closed.K.norm());
      }
}

TEST(RigidDisc, HasTheEigenvaluesOfTheReference)
{
  // SQUEAL reference values with 40 digits; rounding of 1e4 in double: 1e-11, margin of 10.
  const struct {
    double speed_by_pi;
    std::complex<double> lower, higher;
  } rows[] = {{1.0, {-0.4729529826449, 10839.60412518343}, {-3.4347768016379, 10898.22890054795}},
              {5.0, {-1.0468646874162, 10835.81185886162}, {-0.65718126944039, 10902.04349243849}},
              {10.4, {-1.4977089277022, 10825.16422789187}, {0.079718083059662, 10912.76670786779}},
              {20.0, {-1.7835817865162, 10799.81342502281}, {0.49272654730206, 10938.38259488658}}};
  for (const auto& row : rows) {
    const Eigen::Vector2cd lambda =
        eigenvalues(rigid_disc_matrices(source_disc(), row.speed_by_pi * pi));
    EXPECT_LT(std::abs(lambda[0] - row.lower), 1e-10) << row.speed_by_pi;
    EXPECT_LT(std::abs(lambda[1] - row.higher), 1e-10) << row.speed_by_pi;
  }
}

/// Critical speed over pi of the matrices after a change.
template <class Change>
double critical_by_pi(const Change& change)
{
  const StateMatrixAt matrices_at = [&](double speed) {
    RigidMatrices matrices = rigid_disc_matrices(source_disc(), speed);
    change(matrices);
    return first_order(matrices);
  };
  return critical_speed(stability_over_speed(matrices_at, speeds)).value().speed / pi;
}

TEST(RigidDisc, BecomesUnstableAtTheCriticalSpeedOfTheReference)
{
  // SQUEAL reference value with 40 digits. The growth rate, known to 1e-11, rises by 0.03 per unit
  // of speed: 3e-10 rad/s, 1e-11 relative.
  EXPECT_NEAR(critical_by_pi([](RigidMatrices&) {}), 9.478465586019481, 1e-9);
}

TEST(RigidDisc, HasNoCriticalSpeedWithoutFriction)
{
  RigidDisc disc = source_disc();
  disc.friction = {0.0};
  EXPECT_FALSE(critical_speed(stability_over_speed(
      [&](double speed) { return first_order(rigid_disc_matrices(disc, speed)); }, speeds)));
}

// What docs/rigid_disc.md says about equation (3.2) of the source and its 10.4 pi.
TEST(RigidDiscNote, NoReadingOfTheSourceGivesItsCriticalSpeed)
{
  const RigidDisc disc = source_disc();
  const double M_A = 2.0 * disc.friction.kinetic * disc.radius * disc.preload;
  const double printed = critical_by_pi([&](RigidMatrices& m) { m.C(0, 0) -= disc.d_t; });
  const double along_axis = critical_by_pi([&](RigidMatrices& m) {
    m.K(0, 1) -= M_A;
    m.K(1, 0) += M_A;
  });
  const double workless = critical_by_pi([&](RigidMatrices& m) { m.K(1, 0) += M_A; });
  // SQUEAL reference values; tolerance as above.
  EXPECT_NEAR(printed, 7.071993454795727, 1e-9);
  EXPECT_NEAR(along_axis, 10.679787364222378, 1e-9);
  EXPECT_NEAR(workless, 10.032172422448102, 1e-9);
}

TEST(RigidDiscNote, TheDamperThatThePrintedMatrixLacksIsInTheLinearisation)
{
  const RigidDisc disc = source_disc();
  RigidDisc undamped = disc;
  undamped.d_t = 0.0;
  const Eigen::Matrix2d difference =
      linearised(disc, Drive::speed, 6.0 * pi).C - linearised(undamped, Drive::speed, 6.0 * pi).C;
  EXPECT_LT((difference - disc.d_t * Eigen::Matrix2d::Identity()).norm(), 1e-14);
}

}  // namespace
}  // namespace chladni::squeal
