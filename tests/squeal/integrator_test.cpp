#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/error.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/motion/dormand_prince.hpp"
#include "squeal/motion/generalised_alpha.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/transient.hpp"
#include "squeal/transient/transient_steps.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

constexpr IntegratorKind all_kinds[] = {IntegratorKind::splitting, IntegratorKind::exponential,
                                        IntegratorKind::dormand_prince,
                                        IntegratorKind::generalised_alpha};

TEST(Integrator, OfAnyKindGrowsAsTheEigenvaluesSay)
{
  // growth_error is what each of them promises; the fit of the envelope adds less than 1e-4. Just
  // above the critical speed the growth is 0.0165 1/s, at 6 pi it is 2.69 1/s.
  const Disc disc = disc_of({kirchhoff_3()});
  for (const IntegratorKind kind : all_kinds)
    for (const double speed : {4.28 * pi, 6.0 * pi}) {
      const TransientCase run{
          .speed = speed, .duration = 2.0, .initial_pad_displacement = 1e-8, .integrator = kind};
      const Transient result = transient(FlexibleDisc(disc, reference_options()), run);
      const double expected =
          least_stable_eigenvalue(state_matrix(inertial_disc(disc), reference_options(), speed))
              .real();
      ASSERT_TRUE(result.growth_rate) << name_of(kind);
      EXPECT_NEAR(*result.growth_rate, expected, run.growth_error + 1e-4) << name_of(kind);
      EXPECT_EQ(result.integrator, name_of(kind));
    }
}

TEST(Integrator, OfAnyKindReachesTheSameLimitCycle)
{
  // Reference values of SQUEAL at 6 pi for 1672.13 Hz: frequency 1696.8533 Hz and pad velocity
  // 6.727 m/s (bilateral), 1691.1221 Hz and 12.169 m/s (unilateral).
  const Disc disc = disc_of({kirchhoff_3(1672.13)});
  struct Expected {
    ContactLaw law;
    double f_Hz, velocity, start, duration;
  };
  for (const Expected& e : {Expected{ContactLaw::bilateral, 1696.8533, 6.727, 6e-4, 1.6},
                            Expected{ContactLaw::unilateral, 1691.1221, 12.169, 1.1e-3, 2.0}})
    for (const IntegratorKind kind : all_kinds) {
      const Transient run = transient(
          FlexibleDisc(disc, reference_options(e.law)),
          {.speed = 6.0 * pi,
           .duration = e.duration,
           .initial_pad_displacement = e.start,
           .steps_per_period =
               kind == IntegratorKind::generalised_alpha ? std::optional(120) : std::nullopt,
           .integrator = kind});
      const LimitCycle cycle = limit_cycle(run);
      // 120 steps of the trapezoidal rule lower a frequency by (2 pi / 120)^2 / 12 = 2.3e-4 of it.
      const double f_error = kind == IntegratorKind::generalised_alpha ? 3e-4 : 1e-5;
      EXPECT_NEAR(cycle.frequency_Hz, e.f_Hz, f_error * e.f_Hz) << name_of(kind);
      // The motion has settled to 1e-3 by then (multiplier 0.998 of a period).
      EXPECT_NEAR(cycle.pad_velocity, e.velocity, 3e-3 * e.velocity) << name_of(kind);
    }
}

/// A state with contact loss within the next period.
ModalState large_motion(const Disc& disc)
{
  return {Eigen::VectorXd::Constant(disc.n_modes(), 4e-4),
          Eigen::VectorXd::Constant(disc.n_modes(), 4.0)};
}

/// (diag(omega) q, q') in the rotating frame after `time`, by the inertial description.
Eigen::VectorXd by_inertial_frame(const Disc& disc, const SquealOptions& options, double speed,
                                  double time)
{
  const InertialDisc inertial = inertial_disc(disc);
  SlidingDisc motion(inertial, options, speed);
  const ModalState start = large_motion(disc);
  const Eigen::Index n = disc.n_modes();
  Eigen::VectorXd x(2 * n);
  x << inertial.omega.cwiseProduct(inertial.R.transpose() * start.q),
      inertial.R.transpose() * start.v;
  const Eigen::VectorXd end = end_of(motion, {x, time}, 1e-12);
  Eigen::VectorXd y(2 * n);
  const double angle = -speed * time;
  y << disc.omega.cwiseProduct(inertial.R *
                               turned(inertial, end.head(n).cwiseQuotient(inertial.omega), angle)),
      inertial.R * turned(inertial, end.tail(n), angle);
  return y;
}

TEST(RotatingDisc, MovesAsTheInertialDescriptionSays)
{
  // Two independent descriptions, 20 periods with contact loss: 8 significant digits of a motion
  // that two integrators of order 8 know to about 1e-9.
  for (const ContactLaw law :
       {ContactLaw::unilateral, ContactLaw::bilateral, ContactLaw::signed_force}) {
    const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
    const SquealOptions options = reference_options(law);
    const double speed = 6.0 * pi, time = 20.0 / 1750.0;
    const ModalState start = large_motion(disc);
    Eigen::VectorXd y(8);
    y << disc.omega.cwiseProduct(start.q), start.v;
    RotatingDisc motion(disc, options, speed);
    DormandPrince integrator(motion, 0.0, y, {1e-11, 1e-4, 1e-5});
    const Eigen::VectorXd expected = by_inertial_frame(disc, options, speed, time);
    EXPECT_LT((integrator.at(time) - expected).norm(), 1e-8 * expected.norm());
    EXPECT_EQ(integrator.events().size() > 20, law != ContactLaw::signed_force);
  }
}

TEST(Integrator, WithFixedStepsIsOfSecondOrderInTheStep)
{
  // Against order 8 in the other description, five periods with contact loss. Where in a step the
  // contact changes moves the ratio about 4.
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  const SquealOptions options = reference_options(ContactLaw::unilateral);
  const double speed = 6.0 * pi, period = 2.0 * pi / disc.omega.maxCoeff();
  for (const IntegratorKind kind : {IntegratorKind::splitting, IntegratorKind::exponential}) {
    const auto error = [&](int n_steps) {
      const double step = period / n_steps;
      const TransientCase run{.speed = speed, .duration = 1.0, .initial_pad_displacement = 0.0};
      const auto steps =
          transient_steps(disc, options, run, {kind, n_steps, 0.0, ""}, step, large_motion(disc));
      for (int i = 0; i < 5 * n_steps; ++i) steps->next();
      const ModalState end = steps->state();
      Eigen::VectorXd y(8);
      y << disc.omega.cwiseProduct(end.q), end.v;
      const Eigen::VectorXd exact =
          by_inertial_frame(disc, options, speed, (5.0 * n_steps - 0.5) * step);
      return (y - exact).norm() / exact.norm();
    };
    EXPECT_LT(error(160), 1e-3) << name_of(kind);
    EXPECT_NEAR(std::log2(error(80) / error(320)), 4.0, 0.6) << name_of(kind);
  }
}

TEST(RotatingDisc, HasTheTangentOfItsRate)
{
  // Central differences of 1e-6 relative: error 1e-9 of the largest entry.
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  RotatingDisc motion(disc, reference_options(ContactLaw::unilateral), 6.0 * pi);
  const ModalState at = large_motion(disc);
  const Eigen::Index n = disc.n_modes();
  Eigen::VectorXd y(2 * n);
  y << disc.omega.cwiseProduct(at.q), at.v;
  motion.take_sides(0.1, y);
  const Motion::Tangent tangent = motion.tangent(0.1, y);
  Eigen::MatrixXd by_y(n, 2 * n), expected(n, 2 * n);
  for (Eigen::Index j = 0; j < 2 * n; ++j) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(2 * n);
    step[j] = 1e-6 * y.norm();
    const Eigen::VectorXd after = motion.rate(0.1, y + step), before = motion.rate(0.1, y - step);
    by_y.col(j) = (after - before).tail(n) / (2.0 * step[j]);
  }
  expected << tangent.by_q * disc.omega.cwiseInverse().asDiagonal(), tangent.by_v;
  EXPECT_LT((by_y - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.cwiseAbs().maxCoeff());
}

TEST(Integrator, KeepsTheEnergyOfAFrictionlessDisc)
{
  // Seen from the inertial frame, pads without friction do no net work: H = |v|^2 / 2 + |omega q|^2
  // / 2
  // - Omega v' D q + sum over both planes of N_0 h (s - 1) + k (w^2 + h^2 (s - 1)^2 / 4) is
  // constant. About 2500 steps with errors of 1e-14 that need not cancel.
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  const InertialDisc inertial = inertial_disc(disc);
  SquealOptions options = reference_options();
  options.friction.kinetic = 0.0;
  const double speed = 200.0, h = options.thickness;
  const PadPair& pad = options.pads[0];
  const auto energy = [&](double t, const Eigen::VectorXd& y) {
    const Eigen::VectorXd q = y.head(4).cwiseQuotient(disc.omega), v = y.tail(4);
    const Shapes shapes = shapes_at(disc, pad.angle - speed * t);
    const double w = shapes.W.dot(q), g_r = shapes.W_r.dot(q), g_t = shapes.W_t.dot(q);
    const double s = std::sqrt(1.0 + g_r * g_r + g_t * g_t);
    const Eigen::VectorXd a = inertial.R.transpose() * q, p = inertial.R.transpose() * v;
    return 0.5 * y.squaredNorm() - speed * p.dot(inertial.D * a) + pad.preload * h * (s - 1.0) +
           pad.stiffness * (w * w + 0.25 * h * h * (s - 1.0) * (s - 1.0));
  };
  RotatingDisc motion(disc, options, speed);
  Eigen::VectorXd y(8);
  const ModalState start = large_motion(disc);
  y << disc.omega.cwiseProduct(start.q), start.v;
  DormandPrince integrator(motion, 0.0, y, {1e-14, 1e-4, 1e-5});
  const double before = energy(0.0, y);
  double largest = 0.0;
  for (double t = 1e-3; t < 0.05; t += 1e-3)
    largest = std::max(largest, std::abs(energy(t, integrator.at(t)) - before));
  EXPECT_LT(largest, 1e-11 * before);
}

TEST(Integrator, OfAnyKindEndsWhereTheMotionDiverges)
{
  auto body = analytic_body({kirchhoff_3()});
  body.C = -4e4 * Eigen::Matrix2d::Identity();
  const Disc disc = disc_on_ring(body, "track", {});
  for (const IntegratorKind kind : all_kinds) {
    const Transient run = transient(
        FlexibleDisc(disc, reference_options()),
        {.speed = 6.0 * pi, .duration = 1.0, .initial_pad_displacement = 1e-5, .integrator = kind});
    EXPECT_FALSE(run.finished) << name_of(kind);
    ASSERT_FALSE(run.history.t.empty()) << name_of(kind);
    for (const double v : run.history.pad_velocity) EXPECT_TRUE(std::isfinite(v));
  }
}

}  // namespace
}  // namespace chladni::squeal
