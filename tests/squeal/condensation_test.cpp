#include "squeal/condensation/condensation.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <string>
#include <vector>

#include "assembly_parts.hpp"
#include "common/error.hpp"
#include "squeal/models/assembly_brake.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Bodies = std::vector<mbs_export::ModalBody>;

/// A disc between plates whose face nodes have modes of their own, different ones on both sides.
Bodies bending_bodies()
{
  const auto face = sector_points(ring_radius, sector, n_points);
  Bodies bodies = bodies_of_two_plates();
  bodies[1] = bodies[2] = bending_plate(plate, face);
  bodies[2].omega.tail(n_points).setConstant(2.0 * pi * 2500.0);
  return bodies;
}

CondensationOptions up_to(double f_Hz, double tolerance)
{
  return {.tolerance = tolerance, .highest = 2.0 * pi * f_Hz, .speed_from = 5.0, .speed_to = 40.0};
}

Eigen::Index coordinates(const Bodies& bodies)
{
  Eigen::Index n = 0;
  for (const auto& body : bodies) n += body.n_modes();
  return n;
}

/// The largest relative distance of an eigenvalue of the band from the nearest one of the other
/// brake.
double distance(const Bodies& exact, const Bodies& few, double at_speed, double friction,
                double f_Hz)
{
  AssemblyOptions options = two_plates();
  options.friction.kinetic = friction;
  const Eigen::VectorXcd all = AssemblyBrake(options, exact).state_matrix(at_speed).eigenvalues();
  const Eigen::VectorXcd found = AssemblyBrake(options, few).state_matrix(at_speed).eigenvalues();
  double largest = 0.0;
  for (const std::complex<double>& one : all)
    if (one.imag() > 0.0 && one.imag() <= 2.0 * pi * f_Hz)
      largest = std::max(largest, (found.array() - one).abs().minCoeff() / std::abs(one));
  return largest;
}

TEST(Condensation, KeepsTheVibrationsOfTheBandWithFewerCoordinates)
{
  const Bodies bodies = bending_bodies();
  Eigen::Index last = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const CondensedBodies found = condense(two_plates(), bodies, up_to(1500.0, tolerance));
    EXPECT_LE(found.error.eigenvalues, tolerance);
    EXPECT_GT(found.error.n_eigenvalues, 8);
    EXPECT_GE(found.error.n_states, 7);
    ASSERT_TRUE(found.bodies[1].condensation);
    EXPECT_EQ(found.bodies[1].condensation->error, found.error.eigenvalues);
    ASSERT_EQ(found.bodies.size(), 3u);
    const Eigen::Index n = coordinates(found.bodies);
    EXPECT_LT(n, coordinates(bodies));
    EXPECT_GE(n, last);
    last = n;
    // Samples, the middle that was a check, and a state that was none.
    for (const double at_speed : {5.0, 22.5, 40.0, 31.0})
      for (const double friction : {0.0, 0.3, 0.6, 0.45}) {
        EXPECT_LE(distance(bodies, found.bodies, at_speed, friction, 1500.0), 3.0 * tolerance)
            << tolerance << ", " << at_speed << " rad/s, " << friction;
      }
  }
}

TEST(Condensation, KeepsOscillationsOfTheBandThatHardlyOscillate)
{
  // Modes of one plate with a damping ratio of 0.98: at 497 Hz, decaying faster than half of the
  // band's frequencies.
  Bodies bodies = bending_bodies();
  Eigen::VectorXd ratios = Eigen::VectorXd::Zero(bodies[2].n_modes());
  ratios.tail(n_points).setConstant(0.98);
  bodies[2].C = (2.0 * ratios.cwiseProduct(bodies[2].omega)).asDiagonal();
  const double tolerance = 1e-4;
  const CondensedBodies found = condense(two_plates(), bodies, up_to(1500.0, tolerance));
  EXPECT_LE(found.error.eigenvalues, tolerance);
  for (const double at_speed : {5.0, 31.0, 40.0}) {
    EXPECT_LE(distance(bodies, found.bodies, at_speed, 0.6, 1500.0), 3.0 * tolerance)
        << at_speed << " rad/s";
  }
}

/// An oscillator with the eigenvalues lambda and their conjugates.
Eigen::MatrixXd oscillators(const std::vector<std::complex<double>>& lambda)
{
  const auto n = 2 * std::ssize(lambda);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < std::ssize(lambda); ++i) {
    const std::complex<double>& one = lambda[std::size_t(i)];
    A.block<2, 2>(2 * i, 2 * i) << one.real(), one.imag(), -one.imag(), one.real();
  }
  return A;
}

TEST(CondensationError, IsOneWhereABrakeSquealsThatDidNot)
{
  const CondensationOptions wanted{
      .tolerance = 0.01, .highest = 2000.0, .speed_from = 1.0, .speed_to = 2.0};
  const auto error = [&](const std::vector<std::complex<double>>& exact,
                         const std::vector<std::complex<double>>& found) {
    const Eigen::VectorXcd lambda =
        Eigen::Map<const Eigen::VectorXcd>(exact.data(), std::ssize(exact));
    return condensation_error(lambda, oscillators(found), wanted);
  };
  // By half a per cent of the frequency, within the tolerance.
  EXPECT_EQ(error({{-2.0, 1000.0}}, {{3.0, 1000.0}}).eigenvalues, 1.0);
  EXPECT_EQ(error({{3.0, 1000.0}}, {{-2.0, 1000.0}}).eigenvalues, 1.0);
  EXPECT_NEAR(error({{-2.0, 1000.0}}, {{-7.0, 1000.0}}).eigenvalues, 0.005, 1e-6);
  EXPECT_NEAR(error({{-2.0, 1000.0}}, {{-7.0, 1000.0}}).growth, 5.0, 1e-9);
  // Less than 1e-4 of the frequency is neither growth nor decay.
  EXPECT_LT(error({{-0.09, 1000.0}}, {{0.09, 1000.0}}).eigenvalues, 2e-4);
  EXPECT_EQ(error({{-0.09, 1000.0}}, {{3.0, 1000.0}}).eigenvalues, 1.0) << "but this one grows";
  EXPECT_EQ(error({{-3.0, 1000.0}}, {{0.09, 1000.0}}).eigenvalues, 1.0);
  // Each has one of its own, and the band no other.
  EXPECT_EQ(error({{-1.0, 1000.0}, {-1.0, 1001.0}}, {{-1.0, 1000.5}}).eigenvalues, 1.0);
  EXPECT_EQ(error({{-1.0, 1000.0}}, {{-1.0, 1000.0}, {-1.0, 1500.0}}).eigenvalues, 1.0);
  const CondensationError beyond = error({{-1.0, 1000.0}}, {{-1.0, 1000.0}, {5.0, 2500.0}});
  EXPECT_LT(beyond.eigenvalues, 1e-12);
  EXPECT_EQ(beyond.n_unstable_beyond, 1);
}

/// The error that is told is the largest of all states, those between the ends of the ranges too,
/// and the tolerance holds for it wherever it lies: also just below an error that was reached.
TEST(Condensation, KeepsAToleranceJustBelowTheErrorThatItReached)
{
  const Bodies bodies = bending_bodies();
  for (const double end : {40.0, 600.0})
    for (const double f_Hz : {1000.0, 1500.0}) {
      CondensationOptions wanted = up_to(f_Hz, 1e-2);
      wanted.speed_to = end;
      while (wanted.tolerance > 1e-6) {
        const double error = condense(two_plates(), bodies, wanted).error.eigenvalues;
        ASSERT_LE(error, wanted.tolerance) << end << " rad/s, " << f_Hz << " Hz";
        wanted.tolerance = 0.999 * error;
      }
    }
}

TEST(Condensation, OfADiscStaysAxisymmetric)
{
  const Bodies bodies = bending_bodies();
  const CondensedBodies found = condense(two_plates(), bodies, up_to(1500.0, 1e-4));
  const Assembly few = assembly(two_plates(), found.bodies);
  EXPECT_LT(few.disc.largest_impurity, 1e-7);  // a root of a difference of rounding
  EXPECT_LT(few.disc.largest_split, 1e-9);
}

TEST(Condensation, SaysWhatCannotBe)
{
  const auto error = [](const CondensationOptions& wanted) {
    try {
      condense(two_plates(), bending_bodies(), wanted);
    } catch (const Error& failure) {
      return std::string(failure.what());
    }
    return std::string();
  };
  EXPECT_NE(error(up_to(1e-3, 1e-3)).find("has no oscillation below 0.001 Hz"), std::string::npos)
      << error(up_to(1e-3, 1e-3));
  // A tolerance just below what all shapes keep: both are told, with digits that tell them apart.
  const std::string nothing = error(up_to(1500.0, 0.0)), of = "leave an error of ";
  const auto at = nothing.find(of);
  ASSERT_NE(at, std::string::npos) << nothing;
  const double reached = std::stod(nothing.substr(at + of.size()));
  EXPECT_GT(reached, 0.0);
  EXPECT_LT(reached, 1e-6);
}

}  // namespace
}  // namespace chladni::squeal
