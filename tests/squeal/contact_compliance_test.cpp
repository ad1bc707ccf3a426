#include "squeal/brake/linear_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/stability/error_budget.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// The pair of the reference, then interface modes of other harmonics at `scale` times 20 to 50 kHz
/// with the same compliance at each scale.
mbs_export::ModalBody augmented_body(double scale)
{
  std::vector<PlatePair> pairs{kirchhoff_3()};
  for (int n = 0; n < 8; ++n) {
    pairs.push_back({.n = n,
                     .f_Hz = scale * (20e3 + 4e3 * n),
                     .mass = 0.1 / (scale * scale),
                     .U = 0.5 + 0.1 * n,
                     .U_r = 9.0 - 3.0 * n,
                     .U_t = n * 4.1});
  }
  mbs_export::ModalBody body = analytic_body(pairs);
  for (std::size_t i = 2; i < body.kinds.size(); ++i)
    body.kinds[i] = mbs_export::ModeKind::interface;
  return body;
}

SquealOptions two_pads()
{
  SquealOptions options = reference_options();
  options.pads.push_back({.angle = 1.1, .stiffness = 4e6, .damping = 20.0, .preload = 1500.0});
  return options;
}

ModeChoice static_above(double f_Hz)
{
  return {.quasi_static_above = 2.0 * pi * f_Hz};
}

/// The eigenvalue with the largest real part below 3 kHz.
std::complex<double> least_stable_of_the_pair(const Disc& disc, const SquealOptions& options)
{
  const Eigen::VectorXcd lambda =
      state_matrix(inertial_disc(disc), options, 6.0 * pi).eigenvalues();
  std::complex<double> worst = -1e9;
  for (const std::complex<double>& x : lambda)
    if (x.imag() > 0.0 && x.imag() < 2.0 * pi * 3000.0 && x.real() > worst.real()) worst = x;
  return worst;
}

TEST(ContactPatch, FeelsTheMeanOverItsFace)
{
  constexpr int n = 400;
  for (const int d : {0, 1, 7, 30}) {
    for (const double patch : {1e-6, 0.05, 0.3}) {
      double sum = 0.0, area = 0.0;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const double x = (2.0 * i + 1.0) / n - 1.0, y = (2.0 * j + 1.0) / n - 1.0;
          if (x * x + y * y > 1.0) continue;
          area += 1.0;
          sum += std::cos(d * patch * x);
        }
      // The edge of the face goes through cells: n^-3/2.
      EXPECT_NEAR(mean_over_patch(d, patch), sum / area, 5e-4) << d << " " << patch;
    }
  }
}

TEST(ContactPatch, IsAPointOfADiscThatMovesLess)
{
  SquealOptions options = reference_options();
  PlatePair pair = kirchhoff_3();
  options.pads.front().radius = 0.03;
  const Eigen::MatrixXd A = state_matrix(inertial_disc(disc_of({pair})), options, 6.0 * pi);
  options.pads.front().radius.reset();
  const double mean = mean_over_patch(3, 0.03 / ring_radius);
  EXPECT_LT(mean, 0.95);
  for (double* amplitude : {&pair.U, &pair.U_r, &pair.U_t}) *amplitude *= mean;
  const Eigen::MatrixXd less = state_matrix(inertial_disc(disc_of({pair})), options, 6.0 * pi);
  EXPECT_LT((A - less).norm(), 1e-12 * A.norm());
}

TEST(ContactPatch, IsTheSameForTheTurningDisc)
{
  PlatePair turned = kirchhoff_3();
  turned.turn = 0.4;
  const Disc disc = disc_of({kirchhoff_2(), turned, kirchhoff_4()});
  const InertialDisc inertial = inertial_disc(disc);
  SquealOptions options = two_pads();
  options.pads.back().radius = 0.025;
  const PadSystem pads = pad_system(options, ring_places(disc));
  PointShapes shapes(disc);
  for (const PointPair& point : pads.points) {
    EXPECT_LT((inertial.R.transpose() * shapes.at(point, 0.0) - shapes_at(inertial, point)).norm(),
              1e-11);
  }
}

TEST(ContactPatch, HasTheAreaOfTheFaceUnlessAPointIsMeant)
{
  PadPair pad = reference_options().pads.front();
  EXPECT_EQ(patch_radius(pad), 0.0);
  EXPECT_TRUE(lacks_a_size(pad));
  pad.area = pi * 0.02 * 0.02;
  EXPECT_DOUBLE_EQ(patch_radius(pad), 0.02);
  EXPECT_FALSE(lacks_a_size(pad));
  pad.radius = 0.03;
  EXPECT_EQ(patch_radius(pad), 0.03);
  SquealOptions options = reference_options();
  options.pads.front().area = pi * 0.02 * 0.02;
  EXPECT_DOUBLE_EQ(pad_system(options, ring_radius).points.front().patch, 0.02 / ring_radius);
  pad.radius = 0.0;
  EXPECT_EQ(patch_radius(pad), 0.0);
  EXPECT_FALSE(lacks_a_size(pad));
  pad = {.angle = 0.0, .stiffness = 1e6, .damping = 0.0, .preload = 1e3};
  pad.area = 1e-3;
  pad.grid = PadGrid{.sector = 0.3, .points = 3};
  EXPECT_EQ(patch_radius(pad), 0.0);
}

/// Two pairs whose modes the mesh has without error, and what finer elements add at a point.
mbs_export::ModalBody on_a_mesh(double growth_of_compliance)
{
  mbs_export::ModalBody body = analytic_body({kirchhoff_3(), kirchhoff_4()});
  const Eigen::Index n = body.n_modes();
  body.certificate = {
      .fixed = body.fixed,
      .frequencies = body.omega,
      .eta2 = Eigen::VectorXd::Zero(n),
      .mesh_shape_errors = Eigen::MatrixXd::Zero(6, n),
      .mesh_errors = Eigen::VectorXd::Zero(n),
      .mesh_compliances = {.sets = {"track"},
                           .growth = Eigen::Vector3d(growth_of_compliance, 0.0, 0.0)}};
  return body;
}

TEST(ErrorBudget, HoldsWhatFinerElementsAddToTheComplianceUnderAPad)
{
  // A compliance in series with a pad makes it softer: 1 / k + 2 C, for both pads of the pair.
  constexpr double growth = 1e-10, halvings = 2.8, speed = 6.0 * pi;
  SquealOptions options = reference_options();
  const Disc disc = disc_on_ring(on_a_mesh(growth), "track", {});
  const auto lambda = least_stable_of_the_pair(disc, options);
  const auto told = growth_error_budget(FlexibleDisc(disc, options), speed, lambda).mesh;
  double& k = options.pads.front().stiffness;
  k = 1.0 / (1.0 / k + 2.0 * halvings * growth);
  const double softer = least_stable_of_the_pair(disc, options).real();
  ASSERT_TRUE(told);
  EXPECT_GT(*told, 1e-4);
  EXPECT_NEAR(*told, std::abs(softer - lambda.real()), 0.02 * *told);
  // Of modes that are chosen the rest of the disc is none.
  const Disc pair = disc_on_ring(on_a_mesh(growth), "track", {.list = {{1, 2}}});
  const auto of_pair = growth_error_budget(FlexibleDisc(pair, options), speed,
                                           least_stable_of_the_pair(pair, options));
  EXPECT_EQ(of_pair.mesh.value(), 0.0);
}

TEST(ErrorBudget, SaysWhichErrorsItLacks)
{
  mbs_export::ModalBody body = on_a_mesh(1e-10);
  const auto note = [&](const ModeChoice& choice = {}) {
    return note_of_lacking_errors(disc_on_ring(body, "track", choice), body, choice).value_or("");
  };
  EXPECT_EQ(note(), "");
  EXPECT_NE(note({.list = {{1, 2}}}).find("since use_modes leaves out"), std::string::npos);
  body.preparation.n_constrained_modes = 100;
  EXPECT_NE(note().find("keeps no shapes for static forces"), std::string::npos);
  body.preparation.n_constrained_modes = 0;
  body.certificate.mesh_compliances = {};
  EXPECT_NE(note().find("or 200,000 of elements"), std::string::npos);
  body.certificate.fixed = {"rim"};
  EXPECT_NE(note().find("as held at [\"rim\"]"), std::string::npos);
  body.certificate.mesh_errors = {};
  EXPECT_EQ(note(), "");
}

TEST(ContactCompliance, OfModesFarAboveIsWhatTheyDo)
{
  for (const SquealOptions& options : {reference_options(), two_pads()}) {
    for (const double scale : {1.0, 2.0}) {
      const mbs_export::ModalBody body = augmented_body(scale);
      const Disc whole = disc_on_ring(body, "track", static_above(1e9));
      const Disc condensed = disc_on_ring(body, "track", {});
      ASSERT_EQ(whole.n_modes(), 17);
      ASSERT_EQ(condensed.n_modes(), 2);
      EXPECT_EQ(condensed.compliance.mode_numbers.size(), 15U);
      ASSERT_EQ(notes_of(condensed).size(), 1U);
      EXPECT_TRUE(notes_of(condensed)[0].starts_with("15 of the body's modes, from "));
      EXPECT_TRUE(notes_of(whole).empty());
      const auto exact = least_stable_of_the_pair(whole, options);
      const auto error = least_stable_of_the_pair(condensed, options) - exact;
      const auto without =
          least_stable_of_the_pair(disc_on_ring(body, "track", {.list = {{1, 2}}}), options) -
          exact;
      // Without them 2.6e-2 and 5.8e-2 1/s, 1.7 and 2.2 rad/s.
      EXPECT_GT(std::abs(without.real()), 0.02);
      EXPECT_GT(std::abs(without.imag()), 1.5);
      // (omega / omega_q)^2 = 7.7e-3 of that, and n Omega / omega = 5e-3.
      EXPECT_LT(std::abs(error.real()), 6e-3 * std::abs(without.real()) / (scale * scale) + 1e-4);
      EXPECT_LT(std::abs(error.imag()), 5e-3 / (scale * scale) + 1e-3);
    }
  }
}

TEST(ContactCompliance, TakesEveryInterfaceModeBeyondTheRange)
{
  // The pair is the range; a tenth above it begins what the disc does not have.
  mbs_export::ModalBody body = analytic_body(
      {kirchhoff_3(),
       {.n = 4, .f_Hz = 1.1 * kirchhoff_3().f_Hz, .mass = 1.0, .U = 0.6, .U_r = 9.0, .U_t = 18.0}});
  ASSERT_EQ(disc_on_ring(body, "track", {}).n_modes(), 4);
  body.kinds[2] = body.kinds[3] = mbs_export::ModeKind::interface;
  const Disc disc = disc_on_ring(body, "track", {});
  EXPECT_EQ(disc.n_modes(), 2);
  EXPECT_EQ(disc.compliance.mode_numbers, (std::vector{3, 4}));
  EXPECT_EQ(disc_on_ring(body, "track", static_above(1e9)).n_modes(), 4);
}

/// The pair of the reference, at which the range of a tolerance ends, a pair of interface modes a
/// fiftieth above it and a pair of the disc a twentieth above it.
mbs_export::ModalBody body_with_a_pair_beyond_its_range()
{
  const double end_Hz = kirchhoff_3().f_Hz;
  mbs_export::ModalBody body = analytic_body(
      {kirchhoff_3(),
       {.n = 2, .f_Hz = 1.02 * end_Hz, .mass = 1.0, .U = 0.5, .U_r = 5.0, .U_t = 9.0},
       {.n = 4, .f_Hz = 1.05 * end_Hz, .mass = 1.0, .U = 0.6, .U_r = 9.0, .U_t = 18.0}});
  body.kinds[2] = body.kinds[3] = mbs_export::ModeKind::interface;
  body.selection = {.error = 1e-2,
                    .Omega_max = 2.0 * pi * end_Hz,
                    .loads = {},
                    .modes_only = {},
                    .with_interface_modes = {}};
  return body;
}

TEST(ContactCompliance, LeavesTheModesOfTheDiscBeyondATolerancesRangeTheirInertia)
{
  const mbs_export::ModalBody body = body_with_a_pair_beyond_its_range();
  const Disc disc = disc_on_ring(body, "track", {});
  EXPECT_EQ(disc.mode_numbers, (std::vector{1, 2, 5, 6}));
  EXPECT_EQ(disc.compliance.mode_numbers, (std::vector{3, 4}));
  // What the scene says holds for modes of all kinds.
  const Disc said = disc_on_ring(body, "track", static_above(1.01 * kirchhoff_3().f_Hz));
  EXPECT_EQ(said.mode_numbers, (std::vector{1, 2}));
  EXPECT_EQ(said.compliance.mode_numbers, (std::vector{3, 4, 5, 6}));
}

TEST(ContactCompliance, TakesTheInertiaOfShapesThatAReductionHasForResponses)
{
  mbs_export::ModalBody body = body_with_a_pair_beyond_its_range();
  body.certificate.fixed = body.fixed;
  body.certificate.frequencies = body.omega.head(2);
  body.certificate.responses = {.up_to = body.omega[1], .error = 1e-3, .loads = {}};
  const Disc disc = disc_on_ring(body, "track", {});
  EXPECT_EQ(disc.mode_numbers, (std::vector{1, 2}));
  EXPECT_EQ(disc.compliance.mode_numbers, (std::vector{3, 4, 5, 6}));
  // Held otherwise, the body has modes of which the certificate does not know.
  body.certificate.fixed = {"another support"};
  EXPECT_EQ(disc_on_ring(body, "track", {}).mode_numbers, (std::vector{1, 2, 5, 6}));
}

TEST(ContactCompliance, NeedsAModeOfTheDiscWithinTheRange)
{
  mbs_export::ModalBody body = body_with_a_pair_beyond_its_range();
  for (auto& kind : body.kinds) kind = mbs_export::ModeKind::interface;
  body.selection->Omega_max *= 1.001;
  EXPECT_EQ(disc_on_ring(body, "track", {}).mode_numbers, (std::vector{1, 2}));
  body.selection->Omega_max *= 0.9;
  try {
    disc_on_ring(body, "track", {});
    FAIL() << "there is no mode of the disc in the range";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("below which no mode of the disc moves the ring"),
              std::string::npos)
        << error.what();
  }
}

TEST(ContactCompliance, CountsAModeOfUnknownKindAsOneOfTheDisc)
{
  mbs_export::ModalBody body = body_with_a_pair_beyond_its_range();
  body.kinds.resize(4);
  EXPECT_EQ(disc_on_ring(body, "track", {}).mode_numbers, (std::vector{1, 2, 5, 6}));
}

/// State of the pair in the inertial frame, large enough for the pads to let go.
Eigen::VectorXd large_state(Eigen::Index n)
{
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2 * n);
  x.head<2>() << 5.0, -2.0;
  x.segment<2>(n) << 3.0, 8.0;
  return x;
}

TEST(ContactCompliance, StandsInSeriesWithPadsThatLetGo)
{
  // y = G f and f = F(u + y) hold at once, on every branch of the unilateral law.
  SquealOptions options = two_pads();
  options.contact = ContactLaw::unilateral;
  const InertialDisc disc = inertial_disc(disc_on_ring(augmented_body(1.0), "track", {}));
  const PadSystem pads = pad_system(options, ring_places(disc));
  const ContactSeries series(disc.compliance, pads, 6.0 * pi);
  for (const double size : {1e-3, 1.0, -1.0, 20.0}) {
    std::vector<PointMotion> at;
    for (const PointPair& point : pads.points) {
      const Eigen::MatrixX3d S = matrix_of(shapes_at(disc, point.angle));
      const Eigen::VectorXd x = size * large_state(disc.n_modes());
      at.push_back(
          {S.transpose() * x.head(2).cwiseQuotient(disc.omega), S.transpose() * x.tail(2)});
    }
    const std::vector<PointMotion> before = at;
    const auto force = [&](std::size_t i, const PointMotion& motion) {
      const BrakePoint point = brake_point(matrix_of(shapes_at(disc, pads.points[i].angle)), pads,
                                           pads.points[i], 6.0 * pi);
      return contact_at(point, motion, 6.0 * pi).force;
    };
    series.add_to(at, force);
    // A second solution from the first one's forces, point by point through the modes themselves.
    const Disc high =
        disc_on_ring(augmented_body(1.0), "track",
                     {.list = {{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}}});
    Eigen::VectorXd q = Eigen::VectorXd::Zero(high.n_modes());
    for (std::size_t i = 0; i < at.size(); ++i) {
      q += high.omega.cwiseAbs2().cwiseInverse().asDiagonal() *
           (matrix_of(shapes_at(high, pads.points[i].angle)) * force(i, at[i]));
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Eigen::Vector3d y = matrix_of(shapes_at(high, pads.points[i].angle)).transpose() * q;
      EXPECT_LT((at[i].g - before[i].g - y).norm(), 1e-9 * y.norm()) << size;
    }
  }
}

TEST(ContactCompliance, IsTheSameInBothFrames)
{
  // The rate of the same state in the inertial and in the rotating frame, at t = 0.
  const SquealOptions options = two_pads();
  const Disc disc = disc_on_ring(augmented_body(1.0), "track", {});
  const InertialDisc inertial = inertial_disc(disc);
  SlidingDisc sliding(inertial, options, 6.0 * pi);
  RotatingDisc rotating(disc, options, 6.0 * pi);
  const Eigen::VectorXd x = large_state(2);
  const Eigen::VectorXd a_rate = sliding.rate(0.0, x);
  Eigen::VectorXd y(4);
  y << inertial.R * x.head<2>(), inertial.R * x.tail<2>();
  const Eigen::VectorXd q_rate = rotating.rate(0.0, y);
  // p' = -Omega D p + ..., q'' without it.
  const Eigen::Vector2d force = a_rate.tail<2>() + 6.0 * pi * inertial.D * x.tail<2>();
  EXPECT_LT((inertial.R * force - q_rate.tail<2>()).norm(), 1e-9 * force.norm());
  // Without the compliance the forces are others.
  Disc without = disc;
  without.compliance = {};
  const Eigen::Vector2d other = RotatingDisc(without, options, 6.0 * pi).rate(0.0, y).tail<2>();
  EXPECT_GT((q_rate.tail<2>() - other).norm(), 1e-4 * other.norm());
}

TEST(ContactCompliance, IsInTheDerivativesOfTheMotion)
{
  SlidingDisc sliding(inertial_disc(disc_on_ring(augmented_body(1.0), "track", {})), two_pads(),
                      6.0 * pi);
  const Eigen::VectorXd x = 0.01 * large_state(2);
  sliding.take_sides(0.0, x);
  const Eigen::MatrixXd J = sliding.jacobian(x);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const double step = 1e-5;
    Eigen::VectorXd up = x, down = x;
    up[j] += step;
    down[j] -= step;
    const Eigen::VectorXd above = sliding.rate(0.0, up), below = sliding.rate(0.0, down);
    EXPECT_LT(((above - below) / (2.0 * step) - J.col(j)).norm(), 1e-6 * J.col(j).norm());
  }
}

TEST(ContactCompliance, GrowsInTransientsAsItsEigenvaluesSay)
{
  const Disc disc = disc_on_ring(augmented_body(1.0), "track", {});
  const double exact = least_stable_of_the_pair(disc, reference_options()).real();
  for (const IntegratorKind kind :
       {IntegratorKind::splitting, IntegratorKind::exponential, IntegratorKind::dormand_prince}) {
    const Transient run = transient(
        FlexibleDisc(disc, reference_options()),
        {.speed = 6.0 * pi, .duration = 1.5, .initial_pad_displacement = 1e-8, .integrator = kind});
    ASSERT_TRUE(run.growth_rate);
    EXPECT_NEAR(*run.growth_rate, exact, 2e-3) << run.integrator;  // of the mesh of times
  }
}

TEST(ContactCompliance, TakesNoEnergyInALimitCycle)
{
  const FlexibleDisc brake(disc_on_ring(augmented_body(1.0), "track", {}), two_pads());
  ASSERT_FALSE(brake.disc().compliance.empty());
  const CycleEnergy energy = limit_cycle_direct(brake, 12.0 * pi).energy;
  EXPECT_GT(energy.friction.sum(), 0.0);
  // Forces that change sides within a sample leave 1e-4 of it.
  EXPECT_NEAR(energy.friction.sum() + energy.normal.sum() + energy.damping, 0.0,
              2e-4 * energy.friction.cwiseAbs().sum());
}

}  // namespace
}  // namespace chladni::squeal
