#include <gtest/gtest.h>

#include <cmath>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/cvode.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TEST(HardCase, SlipNearZeroIsBoundedByTheRegularisation)
{
  // The signed law at 7 pi reaches 0.017 m/s; a disc that starts beyond its limit cycle at low
  // speed reverses the direction of sliding. Friction stays bounded and the run finite.
  const Disc disc = disc_of({kirchhoff_3()});
  SquealOptions options = reference_options(ContactLaw::signed_force);
  options.friction.regularisation = 1e-3;
  const Transient run =
      transient(FlexibleDisc(disc, options), {.speed = 0.5,
                                              .duration = 0.2,
                                              .initial_pad_displacement = 5e-4,
                                              .steps_per_period = 80,
                                              .integrator = IntegratorKind::splitting});
  EXPECT_TRUE(run.finished);
  EXPECT_LT(run.slip_speed_min, 5e-3);
  EXPECT_LT(run.envelope.pad_velocity.back(), run.envelope.pad_velocity.front());
}

TEST(HardCase, SlidingThatNearlyStopsInEachPeriodHasItsLimitCycle)
{
  // SQUEAL reference value: the slip of the signed law at 7 pi falls to 0.017 m/s, where friction
  // turns about within microseconds; the samples about the minimum are 0.1 us apart.
  const auto cycle = limit_cycle_direct(
      FlexibleDisc(disc_of({kirchhoff_3()}), reference_options(ContactLaw::signed_force)),
      7.0 * pi);
  EXPECT_LT(cycle.slip_speed_min, 0.025);
  EXPECT_GT(cycle.slip_speed_min, 0.016);
  EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6);
  EXPECT_EQ(stability_of(cycle), CycleStability::stable);
}

TEST(HardCase, SlowGrowthNearTheCriticalSpeedIsInTheTransientToo)
{
  // 1.5e-6 of the frequency. The integration is exact for small motions; the fit leaves 1e-4.
  const TransientCase run{.speed = 4.28 * pi, .duration = 3.0, .initial_pad_displacement = 1e-8};
  const Transient result =
      transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), run);
  EXPECT_EQ(result.integrator, "exponential");
  EXPECT_NEAR(result.growth_rate.value(), 0.01653109890077859, 1e-4);
}

TEST(HardCase, SpeedToZeroIsOverdampedInTheEigenvalues)
{
  // SQUEAL reference values. C_11 grows with 1 / Omega: below 0.00625 rad/s the radial slip no
  // longer oscillates, while the other wave grows a little. Rounding of 1e-16 of 4e5 1/s, times
  // the condition of the eigenvalues.
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
  const auto lambda_at = [&](double speed_by_pi) {
    return state_matrix(disc, reference_options(), speed_by_pi * pi).eigenvalues().eval();
  };
  const auto slow = lambda_at(0.01);
  EXPECT_NEAR(slow.real().maxCoeff(), 1.0355966969655128e-4, 1e-9);
  EXPECT_NEAR(slow.real().minCoeff(), -2187.7928611871057, 1e-6);
  const auto slower = lambda_at(1e-4);
  EXPECT_NEAR(slower.real().minCoeff(), -437275.6236390703, 1e-3);
  EXPECT_NEAR((slower.array() + 282.92788948876694).abs().minCoeff(), 0.0, 1e-6);
}

/// 1e-4 pi: the disc slides at 4e-5 m/s, and its vibration moves the contact planes faster than
/// that.
TransientCase slow_run()
{
  return {.speed = 1e-4 * pi,
          .duration = 0.002,
          .initial_pad_displacement = 1e-7,
          .steps_per_period = 40};
}

/// (diag(omega) q, q') of the samples of `slow_run`.
std::vector<Eigen::VectorXd> slow_states(const FlexibleDisc& brake, const Transient& run)
{
  std::vector<Eigen::VectorXd> states;
  for (const ModalState& x : states_of(brake, slow_run(), run.step, run.history.t.size())) {
    states.emplace_back(2 * x.q.size());
    states.back() << brake.disc().omega.cwiseProduct(x.q), x.v;
  }
  return states;
}

TEST(HardCase, SlowSpeedsTakeTheStiffIntegrator)
{
  // Something decays faster than the mode oscillates, and a pad sticks each time that the disc
  // moves as fast along it as it slides. Sticking costs no more steps than it has events: a scheme
  // that rings in it takes 1e5 evaluations and more.
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), reference_options());
  const Transient run = transient(brake, slow_run());
  EXPECT_EQ(run.integrator, "generalised-alpha");
  EXPECT_TRUE(run.finished);
  EXPECT_LT(run.n_contact_evaluations, 5000);
  const double sliding = 1e-4 * pi * ring_radius;
  EXPECT_LT(run.slip_speed_min, 1e-2 * sliding);
  const auto states = slow_states(brake, run);
  EXPECT_LT(states.back().norm(), states.front().head(2).norm());
}

TEST(HardCase, SticksAtSlowSpeedsAsCvodeSays)
{
  if (!has_cvode) GTEST_SKIP() << "built without SUNDIALS";
  // BDF with 1e-9 on the same friction. A step of the transient may err by 3e-4 of |y|; the fast
  // motions that would add the errors up are damped.
  const Disc disc = disc_of({kirchhoff_3()});
  const TransientCase run = slow_run();
  const FlexibleDisc brake(disc, reference_options());
  const Transient result = transient(brake, run);
  RotatingDisc motion(disc, with_friction_at_rest(reference_options(), disc, run.speed), run.speed);
  const ModalState start = transient_start(disc, inertial_disc(disc), run, 0.0);
  Eigen::VectorXd y(4);
  y << disc.omega.cwiseProduct(start.q), start.v;
  const Eigen::VectorXd exact = cvode(motion, y, result.history.t.back(), 1e-9, CvodeMethod::bdf);
  EXPECT_LT((slow_states(brake, result).back() - exact).norm(), 3e-4 * exact.norm());
}

TEST(HardCase, PadsThatMayStickTakeTheStiffIntegratorAtAnySpeed)
{
  // At 0.5 rad/s the disc slides at 0.065 m/s and decays slowly; from 2e-4 m of pad displacement on
  // the contact planes move faster. With the damper mu N_0 / eps of 1 m/s nothing is stiff.
  const Disc disc = disc_of({kirchhoff_3()});
  const auto chosen = [&](double displacement, double eps) {
    SquealOptions options = reference_options();
    options.friction.regularisation = eps;
    const TransientCase run{
        .speed = 0.5, .duration = 0.1, .initial_pad_displacement = displacement};
    return choose_integrator(disc, inertial_disc(disc), options, run).kind;
  };
  EXPECT_EQ(chosen(1e-6, 0.0), IntegratorKind::exponential);
  EXPECT_EQ(chosen(2e-4, 0.0), IntegratorKind::generalised_alpha);
  EXPECT_EQ(chosen(2e-4, 1.0), IntegratorKind::exponential);
}

TEST(HardCase, StiffPadsHoldTheDisc)
{
  // k to infinity pins the cosine mode under the pad, the sine mode is left: its frequency is that
  // of the free pair to N_0 h and the friction, and the other one rises with the root of k.
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
  SquealOptions options = reference_options();
  options.pads[0].stiffness = 6e12;
  const Eigen::VectorXcd lambda = state_matrix(disc, options, 6.0 * pi).eigenvalues();
  const double pinned = std::sqrt(2.0 * 6e12) * disc.rings[0].U[0];
  EXPECT_NEAR(lambda.imag().maxCoeff() / pinned, 1.0, 1e-4);
  const Transient run =
      transient(FlexibleDisc(disc_of({kirchhoff_3()}), options),
                {.speed = 6.0 * pi, .duration = 0.01, .initial_pad_displacement = 1e-12});
  EXPECT_TRUE(run.finished);
}

}  // namespace
}  // namespace chladni::squeal
