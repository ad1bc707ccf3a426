#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "assembly_parts.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/models/assembly_brake.hpp"
#include "squeal/models/parameters.hpp"
#include "squeal/stability/sensitivity.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using Bodies = std::vector<mbs_export::ModalBody>;
using Complex = std::complex<double>;

constexpr double growth_speed = 18.0;

/// Two plates with all that an assembly can have: a rigid joint, properties of faces and of each
/// square metre, a lining with friction of its own over pressure, a plate that is turned.
AssemblyOptions rich_options()
{
  AssemblyOptions options = two_plates();
  options.rings = {"inner", "outer"};
  options.friction = {.kinetic = 0.5, .rise = 0.1, .decay_speed = 2.0, .regularisation = 1e-2};
  options.parts[1].rotation[2] = 0.05;
  for (FaceContact& contact : options.contacts) contact.shares = NodeShares::by_area;
  FaceContact& own = options.contacts[1];
  own.stiffness = {5e9, true};
  own.damping = {2e3, true};
  own.preload = {1e6, true};
  FrictionTable table{.pressures = {2e5, 2e6},
                      .curves = {friction_curve({0.01, 3.0, 12.0}, {0.5, 0.47, 0.44}),
                                 friction_curve({0.01, 3.0, 12.0}, {0.48, 0.44, 0.41})}};
  own.friction =
      FrictionLaw{.kinetic = 1.0, .table = std::make_shared<const FrictionTable>(std::move(table))};
  options.joints[0].stiffness[0] = options.joints[0].damping[0] = 0.0;
  options.joints.push_back({.ends = {PartNodes{"upper", "centre"}, PartNodes{}}, .rigid = {0}});
  return options;
}

Bodies rich_bodies()
{
  std::vector<Eigen::Vector3d> face = sector_points(0.122, sector, 4);
  for (const Eigen::Vector3d& x : sector_points(0.138, sector, 4)) face.push_back(x);
  const mbs_export::ModalBody bends = bending_plate(plate, face);
  return {disc_with_two_rings(), bends, plate_body(plate, face)};
}

/// The growth of the eigenvalue nearest to one of a neighbouring brake.
double growth_near(const AssemblyOptions& options, const Bodies& bodies, const Complex& lambda)
{
  const Eigen::VectorXcd all =
      AssemblyBrake(options, bodies).state_matrix(growth_speed).eigenvalues();
  Eigen::Index at = 0;
  (all.array() - lambda).abs().minCoeff(&at);
  return all[at].real();
}

/// Compares a row with differences of second and fourth order of brakes that are assembled anew,
/// each in coordinates of its own.
void expect_differences(const Gradients& found, const GradientRow& row, double h,
                        const std::function<double(double value, const Complex& lambda)>& growth)
{
  for (std::size_t i = 0; i < found.motions.size(); ++i) {
    const GradientMotion& motion = found.motions[i];
    const Complex lambda(motion.growth, 2.0 * pi * motion.frequency_Hz);
    const auto f = [&](double steps) { return growth(row.value + steps * h, lambda); };
    const double near = (f(1.0) - f(-1.0)) / (2.0 * h), far = (f(2.0) - f(-2.0)) / (4.0 * h);
    // Eigenvalues up to 1e5 1/s err by some 1e-13 of that.
    const double rounding = 3e-8 / h;
    EXPECT_NEAR(row.growth[Eigen::Index(i)], (4.0 * near - far) / 3.0,
                1e-5 * std::abs(near) + std::abs(near - far) + rounding)
        << row.key << ", motion " << i;
  }
}

const GradientRow& row_of(const Gradients& found, const std::string& key)
{
  const auto row = std::ranges::find(found.rows, key, &GradientRow::key);
  if (row == found.rows.end()) throw std::runtime_error("no gradient by " + key);
  return *row;
}

Gradients gradients_of(const AssemblyOptions& options, const Bodies& bodies)
{
  StudyOptions study{};
  study.speeds = {.from = 5.0, .to = 60.0, .count = 12};
  study.gradients = GradientCase{.speed = growth_speed};
  return gradients(AssemblyBrake(options, bodies), study);
}

TEST(AssemblyGradients, OfEveryNumberOfTheSceneAreDifferencesOfAssemblies)
{
  const AssemblyOptions options = rich_options();
  const Bodies bodies = rich_bodies();
  const Gradients found = gradients_of(options, bodies);
  ASSERT_GE(found.motions.size(), 1u);
  const std::vector<AssemblyNumber> numbers = assembly_numbers(options);
  // Six of each part, five and six of springs and dampers, four of a face, one of the factor of its
  // table, thickness.
  EXPECT_EQ(numbers.size(), 12u + 22u + 8u + 1u + 1u);
  for (const AssemblyNumber& number : numbers) {
    const GradientRow& row = row_of(found, number.key);
    EXPECT_EQ(row.value, number.value);
    const double h = number.step > 0.0 ? number.step : 1e-4 * std::abs(number.value);
    expect_differences(found, row, h, [&](double value, const Complex& lambda) {
      AssemblyOptions changed = options;
      number.set(changed, value);
      return growth_near(changed, bodies, lambda);
    });
  }
}

TEST(AssemblyGradients, OfFrequenciesAreDifferencesOfBodies)
{
  const AssemblyOptions options = rich_options();
  const Bodies bodies = rich_bodies();
  const Gradients found = gradients_of(options, bodies);
  const auto of_frequency = [&](std::size_t body, Eigen::Index first, Eigen::Index n,
                                const std::string& key) {
    const GradientRow& row = row_of(found, key);
    expect_differences(found, row, 1e-4 * row.value, [&](double f_Hz, const Complex& lambda) {
      Bodies changed = bodies;
      changed[body].omega.segment(first, n).setConstant(2.0 * pi * f_Hz);
      return growth_near(options, changed, lambda);
    });
  };
  const double f_Hz = bodies[0].omega[0] / (2.0 * pi);
  of_frequency(0, 0, 2,
               fmt::format("frequency of the pair with 3 nodal diameters at {:.6g} Hz", f_Hz));
  of_frequency(1, 6, 1, "frequency of mode 7 of \"upper\" at 2000 Hz");
}

TEST(AssemblyGradients, HavePlacesOfPartsThatRigidJointsHold)
{
  // What is joined twice is held once, wherever the plates are: they are rigid.
  AssemblyOptions options = two_plates();
  const double apart = 2.0 * (half_disc + height);
  for (int twice = 0; twice < 2; ++twice) {
    options.joints.push_back({.ends = {PartNodes{"upper", "centre"}, PartNodes{"lower", "centre"}},
                              .rigid = {0, 1, 2, 3, 4, 5},
                              .span = apart});
  }
  const AssemblyBrake brake(options, bodies_of_two_plates());
  int places = 0;
  for (const BrakeNumber& number : brake.further_numbers()) {
    places += number.key.starts_with("part[") ? 1 : 0;
    EXPECT_NO_THROW(number.with(number.value - number.step)) << number.key;
    EXPECT_NO_THROW(number.with(number.value + number.step)) << number.key;
  }
  EXPECT_EQ(places, 12);
}

}  // namespace
}  // namespace chladni::squeal
