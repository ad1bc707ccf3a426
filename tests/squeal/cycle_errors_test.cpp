#include "squeal/cycle/cycle_errors.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "planar_motions.hpp"
#include "source_disc.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// Whether a verdict contradicts a multiplier that is known.
bool is_wrong(CycleStability told, double multiplier)
{
  return told == (multiplier < 1.0 ? CycleStability::unstable : CycleStability::stable);
}

CycleStability verdict_of(const FloquetMultipliers& multipliers)
{
  return stability_of(BranchPoint{.speed = 0.0,
                                  .frequency_Hz = 0.0,
                                  .pad_velocity = 0.0,
                                  .pad_displacement = 0.0,
                                  .N_min = 0.0,
                                  .N_max = 0.0,
                                  .largest_multiplier = multipliers.largest(),
                                  .multiplier_error = multipliers.error});
}

TEST(FloquetMultipliers, AreSimpleWhereOneIsADoubleEigenvalue)
{
  // X = Q [1 c^T; 0 B] Q^T with the eigenvalue 1 + 1e-6 of B, and an error of 1e-8: the eigenvalues
  // of X itself are off by the root of the error.
  Eigen::Matrix3d X{{1.0, 0.7, -0.4}, {0.0, 1.0 + 1e-6, 0.3}, {0.0, 0.0, 0.5}};
  const Eigen::Matrix3d Q =
      Eigen::HouseholderQR<Eigen::Matrix3d>(Eigen::Matrix3d{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}})
          .householderQ();
  X = Q * X * Q.transpose();
  X += 1e-8 * Eigen::Matrix3d{{0.3, -0.2, 0.5}, {0.6, -0.4, 0.3}, {-0.5, 0.7, 0.2}};
  const Eigen::Vector3d f = 3.0 * Q.col(0);
  const FloquetMultipliers multipliers = floquet_multipliers(X, f, f);
  EXPECT_NEAR(multipliers.largest(), 1.0 + 1e-6, multipliers.error);
  EXPECT_LT(multipliers.error, 1e-7);
  EXPECT_EQ(verdict_of(multipliers), CycleStability::unstable);
  const Eigen::Vector3cd of_X = X.eigenvalues();
  EXPECT_GT((of_X.array() - 1.0).abs().minCoeff(), 1e-6);
}

TEST(CycleStability, IsNotWrongNearAFoldOrAHopfPoint)
{
  // Cycles of known multipliers on both sides of the fold, r^2 = 1/2, and beside the Hopf point,
  // r = 0, each nearer than the one before: exp(T (2 s - 4 s^2)) is 1 at both.
  std::vector<double> squares;
  for (double d = 1e-2; d > 1e-9; d *= 0.2) squares.insert(squares.end(), {0.5 - d, 0.5 + d, d});
  int n_within = 0, n_decided = 0;
  for (const double twist : {0.0, 1.0}) {
    for (const double s : squares) {
      const SubcriticalHopf field{2.0 - s + s * s, twist};
      PlanarMotion motion(field);
      const auto orbit =
          periodic_orbit(motion, {Eigen::Vector2d(std::sqrt(s), 0.0), field.period(s)});
      if (!orbit) continue;  // beside the fold Newton's method has no simple root
      // The other cycle of this speed, with r^2 = 1 - s, may be as near.
      const double found = orbit->at.x.squaredNorm();
      const double multiplier =
          field.multiplier(std::abs(found - s) < std::abs(found - (1.0 - s)) ? s : 1.0 - s);
      const CycleStability verdict = verdict_of(orbit->multipliers);
      SCOPED_TRACE(
          fmt::format("twist {}, s - 1/2 = {:.3g}, found {:.3g}: multiplier {:.3g} + 1, "
                      "told {:.3g} + 1 +- {:.1e}",
                      twist, s - 0.5, found - 0.5, multiplier - 1.0,
                      orbit->multipliers.largest() - 1.0, orbit->multipliers.error));
      EXPECT_FALSE(is_wrong(verdict, multiplier));
      if (verdict != CycleStability::undecided) {
        EXPECT_NEAR(orbit->multipliers.largest(), multiplier, orbit->multipliers.error + 1e-12);
      }
      if (std::abs(multiplier - 1.0) > 1e-5) continue;
      ++n_within;
      n_decided += verdict != CycleStability::undecided;
    }
  }
  // Those beside the Hopf point are decided, those beside the fold are where its place, which moves
  // with the tolerance, does not come between.
  EXPECT_GT(n_within, 10);
  EXPECT_GT(n_decided, 5);
  EXPECT_LT(n_decided, n_within);
}

/// A cycle at a tolerance of 1e-13 with three times the exponentials of the sharpest that tell an
/// error, its multiplier by them, and its amplitudes from 8192 samples.
struct ReferenceCycle {
  double frequency_Hz, velocity, displacement, multiplier;
};

ReferenceCycle reference_of(const Brake& brake, const DirectLimitCycle& cycle)
{
  const auto motion = brake.motion(cycle.speed);
  CycleStart at{cycle.x, 1.0 / cycle.frequency_Hz};
  const Eigen::Index n = at.x.size();
  ReferenceCycle reference{};
  for (int i = 0; i < 3; ++i) {
    const Flow now = flow(*motion, at, 1e-13);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n + 1, n + 1);
    J.topLeftCorner(n, n) = now.derivative - Eigen::MatrixXd::Identity(n, n);
    J.col(n).head(n) = motion->rate_at(now.end);
    J.row(n).head(n) = motion->rate_at(at.x).transpose();
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n + 1);
    rhs.head(n) = at.x - now.end;
    const Eigen::VectorXd change = J.fullPivLu().solve(rhs);
    reference.multiplier =
        floquet_multipliers(now.derivative, motion->rate_at(at.x), motion->rate_at(now.end))
            .largest();
    at.x += change.head(n);
    at.period += change[n];
  }
  constexpr int n_samples = 8192;
  const Eigen::MatrixXd states = states_over_period(*motion, at, n_samples, 1e-13);
  Eigen::VectorXd z(n_samples), z_dot(n_samples);
  for (int i = 0; i < n_samples; ++i) {
    const ContactResult<double> contact = motion->first_contact(states.col(i));
    z[i] = contact.upper.z;
    z_dot[i] = contact.upper.z_dot;
  }
  const PadAmplitudes amplitudes = pad_amplitudes(z, z_dot);
  reference.frequency_Hz = 1.0 / at.period;
  reference.velocity = amplitudes.velocity;
  reference.displacement = amplitudes.displacement;
  return reference;
}

/// A mass on a belt whose friction falls over the speed.
Oscillator oscillator_of_falling_friction()
{
  return {.mass = 2.0,
          .k_x = 4e4,
          .k_y = 4e6,
          .k_xy = 1e5,
          .d_x = 60.0,
          .d_y = 400.0,
          .contact_stiffness = 7e6,
          .preload = 500.0,
          .radius = 0.13,
          .friction = {.kinetic = 0.3, .rise = 0.3, .decay_speed = 0.5, .regularisation = 2e-2}};
}

struct Case {
  std::string name;
  std::shared_ptr<const Brake> brake;
  double speed;
};

std::vector<Case> cases()
{
  std::vector<Case> all;
  for (const ContactLaw law :
       {ContactLaw::bilateral, ContactLaw::unilateral, ContactLaw::signed_force}) {
    const std::string name = fmt::format("law {}", static_cast<int>(law));
    all.push_back({"two modes, " + name,
                   std::make_shared<FlexibleDisc>(disc_of({kirchhoff_3()}), reference_options(law)),
                   6.0 * pi});
    all.push_back({"rigid disc, " + name,
                   std::make_shared<RigidDiscBrake>(RigidDiscStudy{.disc = source_disc(law)}),
                   20.0 * pi});
  }
  SquealOptions two_pads = reference_options(ContactLaw::unilateral);
  two_pads.pads.push_back(two_pads.pads.front());
  two_pads.pads.back().angle = 1.2;
  all.push_back({"six modes, two pads",
                 std::make_shared<FlexibleDisc>(
                     disc_of({kirchhoff_2(), kirchhoff_3(), kirchhoff_4()}), two_pads),
                 12.0 * pi});
  SquealOptions heavy = reference_options(ContactLaw::unilateral);
  heavy.pads.front().stiffness = 2e7;
  heavy.pads.front().body = PadBody{.mass = 0.1, .axial = Suspension{9e6, 2.0}};
  all.push_back({"pad with a mass", std::make_shared<FlexibleDisc>(disc_of({kirchhoff_3()}), heavy),
                 6.0 * pi});
  all.push_back(
      {"oscillator", std::make_shared<SlidingBrake>(oscillator_of_falling_friction()), 2.0});
  return all;
}

TEST(CycleErrors, OfTheIntegrationAreThoseThatAFinerOneFinds)
{
  for (const auto& [name, brake, speed] : cases()) {
    SCOPED_TRACE(name);
    const DirectLimitCycle cycle = limit_cycle_direct(*brake, speed);
    const CycleErrors errors = cycle_errors(*brake, cycle);
    const ReferenceCycle reference = reference_of(*brake, cycle);
    const auto check = [&](const char* what, double told, double found, double size) {
      EXPECT_GE(told + 1e-11 * size, 0.5 * found) << what;
      EXPECT_LE(told, 2.0 * found + 1e-11 * size) << what;
    };
    check("frequency", errors.frequency_Hz.integration.value(),
          std::abs(cycle.frequency_Hz - reference.frequency_Hz), cycle.frequency_Hz);
    check("velocity", errors.pad_velocity.integration.value(),
          std::abs(cycle.pad_velocity - reference.velocity), cycle.pad_velocity);
    check("displacement", errors.pad_displacement.integration.value(),
          std::abs(cycle.pad_displacement - reference.displacement), cycle.pad_displacement);
    const double found = std::abs(std::abs(cycle.multipliers[1]) - reference.multiplier);
    EXPECT_GE(*cycle.multiplier_error + 1e-11, found);
    EXPECT_FALSE(is_wrong(stability_of(cycle), reference.multiplier));
  }
}

std::array<double, 3> numbers_of(const DirectLimitCycle& cycle)
{
  return {cycle.frequency_Hz, cycle.pad_velocity, cycle.pad_displacement};
}

TEST(CycleErrors, OfTheBodyAreThoseOfABodyThatIsOffSoMuch)
{
  // Of first order, for errors of 1e-6 of the frequencies of each pair: derivatives by a few
  // harmonics are off by up to a fifth where contact is lost, and where they nearly vanish by a
  // thirtieth of what the same part of the number itself is.
  constexpr double error = 1e-6;
  for (const auto& [name, brake, speed] : cases()) {
    const FlexibleDisc* body = brake->body();
    if (!body) continue;
    SCOPED_TRACE(name);
    const DirectLimitCycle cycle = limit_cycle_direct(*brake, speed);
    const CycleStart at{cycle.x, 1.0 / cycle.frequency_Hz};
    for (Eigen::Index i = 0; i < body->disc().n_modes(); i += 2) {
      Disc off = body->disc(), knowing = body->disc();
      off.omega.segment(i, 2) *= 1.0 + error;
      knowing.errors.range = 1e9;
      knowing.errors.reduction = Eigen::VectorXd::Zero(off.n_modes());
      knowing.errors.reduction.segment(i, 2).setConstant(error);
      const CycleErrors errors = cycle_errors(FlexibleDisc(knowing, body->options()), cycle);
      const auto other = limit_cycle_near(FlexibleDisc(off, body->options()), speed, at);
      ASSERT_TRUE(other);
      const std::array<double, 3> told{errors.frequency_Hz.reduction.value(),
                                       errors.pad_velocity.reduction.value(),
                                       errors.pad_displacement.reduction.value()};
      for (std::size_t k = 0; k < 3; ++k) {
        const double found = std::abs(numbers_of(*other)[k] - numbers_of(cycle)[k]);
        EXPECT_NEAR(told[k], found, 0.2 * found + 0.03 * error * numbers_of(cycle)[k])
            << "mode " << i << ", number " << k;
      }
    }
  }
}

}  // namespace
}  // namespace chladni::squeal
