#include "squeal/friction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/numerics.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

std::vector<double> equally_spaced(double from, double to, int n)
{
  std::vector<double> x;
  for (int i = 0; i < n; ++i) x.push_back(from + (to - from) * i / (n - 1));
  return x;
}

/// Falls with the speed and with the pressure, and more so when it is hot.
double law(double v, double p, double T)
{
  return 0.3 + 0.2 * std::exp(-v / 1.5) - 0.05 * std::tanh(p / 2e6) * (1.0 + T / 400.0);
}

FrictionTable sampled(int n_speeds, int n_pressures, const std::vector<double>& temperatures)
{
  FrictionTable table{.temperatures = temperatures,
                      .pressures = equally_spaced(2e5, 4e6, n_pressures),
                      .curves = {}};
  const std::vector<double> speeds = equally_spaced(0.1, 6.0, n_speeds);
  for (const double T : temperatures)
    for (const double p : table.pressures) {
      std::vector<double> mu;
      for (const double v : speeds) mu.push_back(law(v, p, T));
      table.curves.push_back(friction_curve(speeds, mu));
    }
  return table;
}

/// Largest error of the value within the table, away from the end points.
double error_of_table(int n)
{
  const FrictionTable table = sampled(n, n, {100.0, 200.0});
  double largest = 0.0;
  for (const double v : equally_spaced(0.7, 5.3, 57))
    for (const double p : equally_spaced(6e5, 3.5e6, 41)) {
      largest =
          std::max(largest, std::abs(friction_at(table, 150.0, {v, p}).mu - law(v, p, 150.0)));
    }
  return largest;
}

TEST(FrictionTable, ConvergesToTheLawItSamples)
{
  // Slopes of parabolas and weighted harmonic means are of second order: mu is of third.
  const double coarse = error_of_table(11), fine = error_of_table(21);
  EXPECT_LT(fine, 2e-5);
  EXPECT_GT(std::log2(coarse / fine), 2.7);
}

TEST(FrictionTable, HasItsPointsAndIsLinearInTheTemperature)
{
  const FrictionTable table = sampled(7, 5, {100.0, 200.0, 400.0});
  for (const double p : table.pressures)
    for (const double v : table.curves.front().speeds)
      EXPECT_NEAR(friction_at(table, 200.0, {v, p}).mu, law(v, p, 200.0), 1e-15);
  const auto at = [&](double T) { return friction_at(table, T, {1.234, 1.7e6}).mu; };
  EXPECT_NEAR(at(250.0), 0.75 * at(200.0) + 0.25 * at(400.0), 1e-15);
}

TEST(FrictionTable, IsMonotoneOverTheSpeedWhereItsPointsAre)
{
  // A step between flat parts, where splines overshoot.
  const FrictionTable table{
      .curves = {friction_curve({0.0, 1.0, 1.1, 2.0, 5.0}, {0.5, 0.5, 0.3, 0.3, 0.29})}};
  double last = 0.5;
  for (const double v : equally_spaced(0.0, 5.0, 1001)) {
    const FrictionValue value = friction_at(table, 20.0, {v, 0.0});
    EXPECT_LE(value.mu, last + 1e-15);
    EXPECT_LE(value.by_speed, 1e-15);
    last = value.mu;
  }
}

TEST(FrictionTable, KnowsItsDerivatives)
{
  const FrictionTable table = sampled(9, 6, {100.0, 200.0});
  constexpr double h_v = 1e-6, h_p = 1.0;
  for (const double v : {0.15, 0.8375, 2.0, 5.9})
    for (const double p : {2.5e5, 1.72e6, 3.9e6}) {
      const auto mu = [&](double x, double y) { return friction_at(table, 130.0, {x, y}).mu; };
      const FrictionValue value = friction_at(table, 130.0, {v, p});
      // Central differences: second order, and rounding over the step.
      EXPECT_NEAR(value.by_speed, (mu(v + h_v, p) - mu(v - h_v, p)) / (2.0 * h_v), 1e-8);
      EXPECT_NEAR(value.by_pressure * 1e6, (mu(v, p + h_p) - mu(v, p - h_p)) / (2.0 * h_p) * 1e6,
                  1e-8);
    }
}

TEST(FrictionTable, GivesComplexStepsItsDerivatives)
{
  const FrictionLaw measured{
      .kinetic = 1.2,
      .table = std::make_shared<const FrictionTable>(sampled(9, 6, {100.0, 200.0})),
      .temperature = 130.0};
  using Complex = std::complex<double>;
  const FrictionValue value = friction_at(*measured.table, 130.0, {2.1, 1.1e6});
  const Complex by_speed =
      friction_coefficient(measured, Complex(2.1, complex_step), Complex(1.1e6));
  const Complex by_pressure =
      friction_coefficient(measured, Complex(2.1), Complex(1.1e6, complex_step));
  EXPECT_NEAR(by_speed.imag() / complex_step, 1.2 * value.by_speed, 1e-15);
  EXPECT_NEAR(by_pressure.imag() / complex_step, 1.2 * value.by_pressure, 1e-20);
  EXPECT_EQ(friction_coefficient(measured, 2.1, 1.1e6), 1.2 * value.mu);
}

SquealOptions measured_options(int n)
{
  SquealOptions options = reference_options();
  options.friction = {.kinetic = 1.0,
                      .table = std::make_shared<const FrictionTable>(sampled(n, n, {100.0, 200.0})),
                      .temperature = 150.0};
  options.pads.front().area = 2e-3;  // 1 MPa under 2 kN
  return options;
}

/// The linearised contact of the law itself in place of its table: mu(v, p) about the place at rest
/// as a law of a few terms would have it, by central differences of the force.
TEST(FrictionTable, LinearisesTheContactAsDifferencesOfItsForceDo)
{
  const SquealOptions options = measured_options(12);
  const PadContact pad =
      pad_contact(options, options.pads[0], faces_of_plate(options.thickness, ring_radius));
  // Steps at which rounding of 2 kN and the curvature are small.
  constexpr double speed = 18.0, h = 1e-7, h_rate = 1e-4;
  const PairDerivatives exact = pair_derivatives(pad, speed, middle_rows);
  const RestStates at_rest = states_at_rest(pad, speed);
  const auto force = [&](const PairVector<double>& g, const PairVector<double>& g_dot) {
    const PairMotion<double> m = pair_motion(g, g_dot);
    return pair_forces(pad, m, contact(pad, m, speed), at_rest, middle_rows);
  };
  const PairVector<double> zero = PairVector<double>::Zero(middle_rows);
  double largest = 0.0;
  for (int j = 0; j < middle_rows; ++j) {
    PairVector<double> step = zero, rate_step = zero;
    step[j] = h;
    rate_step[j] = h_rate;
    const Eigen::VectorXd by_motion = (force(step, zero) - force(-step, zero)) / (2.0 * h);
    const Eigen::VectorXd by_rate =
        (force(zero, rate_step) - force(zero, -rate_step)) / (2.0 * h_rate);
    largest = std::max(largest, (by_motion - exact.D_a.col(j)).norm() / exact.D_a.norm());
    largest = std::max(largest, (by_rate - exact.D_p.col(j)).norm() / exact.D_p.norm());
  }
  EXPECT_LT(largest, 1e-7);
  // The pressure takes part: without it the same pad has another linearisation.
  PadContact without = pad;
  without.friction.kinetic = friction_at(*pad.friction.table, 150.0, {speed * ring_radius, 1e6}).mu;
  without.friction.table.reset();
  EXPECT_GT((pair_derivatives(without, speed, middle_rows).D_a - exact.D_a).norm(),
            1e-4 * exact.D_a.norm());
}

TEST(FrictionTable, OfAFallingLawIsThatLawInTheStateMatrix)
{
  // The Stribeck law sampled at 60 speeds; no dependence on pressure and temperature.
  SquealOptions options = reference_options();
  options.friction = {.kinetic = 0.4, .rise = 0.3, .decay_speed = 1.5};
  const FlexibleDisc analytic(disc_of({kirchhoff_3()}), options);
  const std::vector<double> speeds = equally_spaced(0.5, 5.0, 60);
  std::vector<double> mu;
  for (const double v : speeds) mu.push_back(friction_coefficient(options.friction, v));
  options.friction = {.kinetic = 1.0,
                      .table = std::make_shared<const FrictionTable>(
                          FrictionTable{.curves = {friction_curve(speeds, mu)}})};
  const FlexibleDisc measured(disc_of({kirchhoff_3()}), options);
  for (const double speed : {6.0, 18.0, 30.0}) {
    const Eigen::MatrixXd A = analytic.state_matrix(speed), B = measured.state_matrix(speed);
    // mu to 1e-6, its slope to 1e-3 of it.
    EXPECT_LT((A - B).norm(), 1e-6 * A.norm()) << speed;
  }
}

std::string complaint_at(const SquealOptions& options, double speed)
{
  try {
    FlexibleDisc(disc_of({kirchhoff_3()}), options).state_matrix(speed);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FrictionTable, RefusesWhatItDoesNotReach)
{
  SquealOptions options = measured_options(5);
  EXPECT_EQ(complaint_at(options, 18.0), "");
  EXPECT_NE(complaint_at(options, 80.0).find("sliding at 10.4 m/s"), std::string::npos);
  EXPECT_NE(complaint_at(options, 80.0).find("outside its range, 0.1 to 6 m/s"), std::string::npos);
  options.pads.front().preload = 2e4;
  EXPECT_NE(complaint_at(options, 18.0).find("a pressure of 1e+07 Pa"), std::string::npos);
  options.pads.front().preload = 2e3;
  options.friction.temperature = 20.0;
  EXPECT_NE(complaint_at(options, 18.0).find("a temperature of 20 degrees Celsius"),
            std::string::npos);
  options.pads.front().area.reset();
  EXPECT_NE(complaint_at(options, 18.0).find("pads[0].area"), std::string::npos);
}

TEST(FrictionOfPads, IsThatOfEachPair)
{
  SquealOptions options = reference_options();
  PadPair other = options.pads.front();
  other.angle = 2.0;
  options.pads.push_back(other);
  options.friction.kinetic = 0.6;
  options.pads[1].friction = FrictionLaw{.kinetic = 0.3};
  const PadSystem pads = pad_system(options, ring_radius);
  EXPECT_EQ(pads.points[0].contact.friction.kinetic, 0.6);
  EXPECT_EQ(pads.points[1].contact.friction.kinetic, 0.3);
}

TEST(Shim, InSeriesIsTheComplexSpringAtItsFrequency)
{
  const Shim shim{.stiffness = 4e7, .loss_factor = 0.3, .frequency_Hz = 1700.0};
  const Suspension both = in_series({.stiffness = 6e6, .damping = 40.0}, shim);
  const double omega = 2.0 * pi * 1700.0;
  using Complex = std::complex<double>;
  // Compliances add.
  const Complex compliance = 1.0 / Complex(6e6, omega * 40.0) + 1.0 / (4e7 * Complex(1.0, 0.3));
  EXPECT_LT(std::abs(compliance * Complex(both.stiffness, omega * both.damping) - 1.0), 1e-14);
  // One that is far stiffer than the lining leaves it as it is.
  const Suspension stiff = in_series({6e6, 40.0}, {6e18, 1.0, 1700.0});
  EXPECT_NEAR(stiff.stiffness, 6e6, 1e-5);
  EXPECT_NEAR(stiff.damping, 40.0, 1e-9);
}

TEST(Shim, LiesBehindTheLiningOrThePlate)
{
  const Shim shim{.stiffness = 4e7, .loss_factor = 0.3, .frequency_Hz = 1700.0};
  SquealOptions options = reference_options();
  options.pads.front().shim = shim;
  const Suspension both =
      in_series({options.pads.front().stiffness, options.pads.front().damping}, shim);
  const PadContact contact = pad_system(options, ring_radius).points[0].contact;
  EXPECT_EQ(contact.spring.linear, both.stiffness);
  EXPECT_EQ(contact.damping, both.damping);
  options.pads.front().body = PadBody{.mass = 0.3, .axial = Suspension{5e6, 30.0}};
  const PadSystem plates = pad_system(options, ring_radius);
  EXPECT_EQ(plates.points[0].contact.spring.linear, options.pads.front().stiffness);
  EXPECT_NEAR(plates.omega[0], std::sqrt(in_series({5e6, 30.0}, shim).stiffness / 0.3), 1e-9);
}

}  // namespace
}  // namespace chladni::squeal
