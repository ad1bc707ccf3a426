#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/error.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

SquealOptions options_with_grid(const PadPair& pad, ContactLaw law = ContactLaw::bilateral)
{
  SquealOptions options = reference_options(law);
  options.pads = {pad};
  return options;
}

PadPair pad_of_grid(double sector, int points)
{
  PadPair pad = reference_options().pads.front();
  pad.grid = PadGrid{.sector = sector, .points = points};
  return pad;
}

TEST(PadGrid, SharesStiffnessAndPreloadAmongPointsInTheMiddleOfEqualParts)
{
  const PadSystem pads = pad_system(options_with_grid(pad_of_grid(0.6, 3)), ring_radius);
  ASSERT_EQ(pads.points.size(), 3u);
  double stiffness = 0.0, preload = 0.0;
  for (const PointPair& point : pads.points) {
    stiffness += point.contact.spring.linear;
    preload += point.contact.preload;
  }
  EXPECT_DOUBLE_EQ(stiffness, 6e6);
  EXPECT_DOUBLE_EQ(preload, 2000.0);
  EXPECT_NEAR(pads.points[0].angle, -0.2, 1e-15);
  EXPECT_NEAR(pads.points[1].angle, 0.0, 1e-15);
  EXPECT_NEAR(pads.points[2].angle, 0.2, 1e-15);
}

TEST(PadGrid, OfOnePointOrNoWidthIsThePadOfOnePoint)
{
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
  const Eigen::MatrixXd one = state_matrix(disc, reference_options(), 18.0);
  for (const PadPair& pad : {pad_of_grid(0.5, 1), pad_of_grid(1e-9, 7)})
    EXPECT_LT((state_matrix(disc, options_with_grid(pad), 18.0) - one).norm(), 1e-8 * one.norm());
}

TEST(PadGrid, ConvergesToTheIntegralOverTheSector)
{
  // The pad spring on the cosine mode is k times the mean of cos^2(3 phi) over the sector, the
  // midpoint rule converges to it with the square of the spacing.
  const double sector = 0.7;
  const double mean = 0.5 + std::sin(3.0 * sector) / (6.0 * sector);
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
  const auto stiffness = [&](int points) {
    SquealOptions options = options_with_grid(pad_of_grid(sector, points));
    options.friction.kinetic = 0.0;
    options.pads[0].preload = 1e-9;
    const Eigen::MatrixXd A = state_matrix(disc, options, 18.0);
    return -(A(2, 0) + disc.omega[0]) * disc.omega[0] /
           (2.0 * 6e6 * disc.rings[0].U[0] * disc.rings[0].U[0]);
  };
  const double error = stiffness(8) - mean, finer = stiffness(16) - mean;
  EXPECT_LT(std::abs(error), 0.01);
  EXPECT_NEAR(error / finer, 4.0, 0.1);
}

TEST(PadGrid, LosesContactPointByPoint)
{
  // Tilted so that one end of the face leaves while the other one presses.
  const Disc disc = disc_of({kirchhoff_3()});
  const SquealOptions options = options_with_grid(pad_of_grid(0.6, 4), ContactLaw::unilateral);
  ContactKick kick(disc, options, 18.0);
  ModalState x{Eigen::Vector2d(0.0, 1.5e-3), Eigen::Vector2d::Zero()};
  const ContactResult<double> pad = kick.apply(x, 0.0, 1e-9).front();
  // w(phi) is odd about the pad; linear springs alone would leave the sum at the preload.
  EXPECT_GT(pad.upper.N, 2100.0);
  EXPECT_GT(pad.lower.N, 2100.0);
}

/// The reference body with a second ring: the mode shapes at 0.11 m (made up: the shape falls with
/// the square of the radius; slopes are its derivatives).
mbs_export::ModalBody body_with_two_rings()
{
  auto body = analytic_body({kirchhoff_3()});
  mbs_export::ContactRing inner = body.rings[0];
  inner.name = "inner";
  inner.radius = 0.11;
  const double part = 0.11 / 0.13;
  inner.W *= part * part;
  inner.W_r *= part;
  inner.W_t *= part;
  body.rings.push_back(inner);
  return body;
}

PadPair pad_on(const std::vector<std::string>& rings, int points = 3)
{
  PadPair pad = pad_of_grid(0.5, points);
  pad.grid->rings = rings;
  return pad;
}

Disc disc_for(const PadPair& pad)
{
  return make_disc(body_with_two_rings(), ring_choice(options_with_grid(pad)), {});
}

TEST(PadGrid, OnTwoRingsIsTheMeanOfThePadsOnEach)
{
  // Linear contact is linear in stiffness and preload, of which each ring has half.
  const auto matrix = [](const PadPair& pad) {
    return state_matrix(inertial_disc(disc_for(pad)), options_with_grid(pad), 18.0);
  };
  const Eigen::MatrixXd both = matrix(pad_on({"track", "inner"}));
  const Eigen::MatrixXd mean = 0.5 * (matrix(pad_on({"track"})) + matrix(pad_on({"inner"})));
  EXPECT_LT((both - mean).norm(), 1e-12 * mean.norm());
  EXPECT_GT((matrix(pad_on({"track"})) - mean).norm(), 1e-4 * mean.norm());
}

TEST(PadGrid, SharesItsForcesAmongAllRings)
{
  const PadSystem pads =
      pad_system(options_with_grid(pad_on({"inner", "track"})), {{"track", 0.13}, {"inner", 0.11}});
  ASSERT_EQ(pads.points.size(), 6u);
  double preload = 0.0;
  for (const PointPair& point : pads.points) preload += point.contact.preload;
  EXPECT_DOUBLE_EQ(preload, 2000.0);
  EXPECT_EQ(pads.points[0].rings[0], 1u);
  EXPECT_EQ(pads.points[0].contact.faces[0].radius, 0.11);
  EXPECT_EQ(pads.points[3].rings[1], 0u);
  EXPECT_EQ(pads.points[3].contact.faces[1].radius, 0.13);
}

TEST(PadGrid, OnTwoRingsGrowsInTimeAsItsEigenvaluesSayUnderEveryIntegrator)
{
  // What the integrators leave is 1e-3 1/s; the decaying wave leaves as much to the fit.
  const PadPair pad = pad_on({"track", "inner"}, 2);
  const SquealOptions options = options_with_grid(pad);
  const Disc disc = disc_for(pad);
  const double speed = 12.0 * pi;
  const double growth =
      least_stable_eigenvalue(state_matrix(inertial_disc(disc), options, speed)).real();
  ASSERT_GT(growth, 0.1);
  EXPECT_NEAR(rotation_growth(disc, options, speed).growth, growth, 1e-4);
  TransientCase run{.speed = speed, .duration = 1.0, .initial_pad_displacement = 3e-8};
  for (const IntegratorKind kind :
       {IntegratorKind::exponential, IntegratorKind::splitting, IntegratorKind::dormand_prince}) {
    run.integrator = kind;
    run.steps_per_period = kind == IntegratorKind::splitting ? 160 : 20;
    EXPECT_NEAR(transient(FlexibleDisc(disc, options), run).growth_rate.value(), growth, 2e-3)
        << static_cast<int>(kind);
  }
}

TEST(PadGrid, OnTwoRingsHasALimitCycle)
{
  const PadPair pad = pad_on({"track", "inner"}, 2);
  const DirectLimitCycle cycle = limit_cycle_direct(
      FlexibleDisc(disc_for(pad), options_with_grid(pad, ContactLaw::unilateral)), 12.0 * pi);
  EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6);
  EXPECT_EQ(stability_of(cycle), CycleStability::stable);
}

TEST(PadGrid, RefusesARingThatTheDiscDoesNotHave)
{
  EXPECT_THROW(pad_system(options_with_grid(pad_on({"outer"})), ring_radius), Error);
  EXPECT_THROW(make_disc(body_with_two_rings(), RingChoice{.names = {"track", "outer"}}, {}),
               Error);
}

TEST(PadGrid, HasEventsOfEveryPointUnderItsPad)
{
  const Disc disc = disc_of({kirchhoff_3()});
  SquealOptions options = options_with_grid(pad_of_grid(0.6, 3), ContactLaw::unilateral);
  options.pads.push_back(pad_of_grid(0.6, 3));
  options.pads[1].angle = 2.0;
  // Three times the compression of the pads at rest, so that every pad leaves.
  const TransientCase run{.speed = 6.0 * pi,
                          .duration = 3e-3,
                          .initial_pad_displacement = 1e-3,
                          .integrator = IntegratorKind::dormand_prince};
  std::vector<int> n_events(4, 0);
  for (const ContactEvent& event : transient(FlexibleDisc(disc, options), run).events)
    ++n_events.at(static_cast<std::size_t>(event.pad));
  for (const int n : n_events) EXPECT_GE(n, 3);  // one for each point
}

TEST(Pads, AtDifferentAnglesAddTheirForces)
{
  // Two pad pairs a quarter period of the mode apart, 30 degrees, hold both modes alike: without
  // friction the frequencies of the pair stay together.
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
  SquealOptions options = reference_options();
  options.friction.kinetic = 0.0;
  options.pads.push_back(options.pads[0]);
  options.pads[1].angle = pi / 6.0;
  const Eigen::MatrixXd A = state_matrix(disc, options, 1e-6);
  Eigen::VectorXd omega = A.eigenvalues().imag();
  std::ranges::sort(omega);
  EXPECT_NEAR(omega[3] - omega[2], 0.0, 1e-4);
  EXPECT_GT(omega[3], disc.omega[0] + 50.0);
}

}  // namespace
}  // namespace chladni::squeal
