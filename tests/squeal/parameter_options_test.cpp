#include "squeal/parameter_options.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "common/error.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/unstable_modes.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/squeal/linked_rings.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// A brake that has every parameter of a body.
SquealOptions full_options()
{
  SquealOptions options = reference_options();
  options.friction = {.kinetic = 0.4, .rise = 0.2, .decay_speed = 0.5, .regularisation = 1e-2};
  PadPair& pad = options.pads.front();
  pad.damping = 5.0;
  pad.grid = PadGrid{.sector = 0.4, .points = 3};
  pad.body = PadBody{.mass = 0.3,
                     .height = 0.01,
                     .radial = Suspension{3e7, 20.0},
                     .tangential = Suspension{2e7, 20.0},
                     .axial = Suspension{5e6, 30.0},
                     .about_radial = RotarySuspension{1.5e-4, {3e3, 0.05}},
                     .about_tangential = RotarySuspension{1e-4, {2e3, 0.05}},
                     .about_axial = RotarySuspension{2e-4, {2e4, 0.05}}};
  pad.caliper = Caliper{.mass = 3.0, .axial = {4e6, 10.0}};
  return options;
}

std::string complaint_of_value(const Brake& brake, MapParameter parameter, double value)
{
  try {
    brake.with(parameter, value);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// mu over pressure, speed and temperature.
FrictionLaw measured()
{
  const auto curve = [](double mu) { return friction_curve({1e-3, 3.0}, {mu, 0.9 * mu}); };
  const FrictionTable table{.temperatures = {0.0, 200.0},
                            .pressures = {0.0, 1e9},
                            .curves = {curve(0.5), curve(0.4), curve(0.45), curve(0.3)}};
  return {
      .kinetic = 1.0, .table = std::make_shared<const FrictionTable>(table), .temperature = 50.0};
}

/// Brakes that have all parameters of a body together: one cannot have two laws of friction.
std::vector<FlexibleDisc> brakes_of_a_body()
{
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  SquealOptions falling = full_options(), by_table = full_options();
  falling.pads.front().friction = measured();
  by_table.friction = measured();
  by_table.pads.front().friction = FrictionLaw{.kinetic = 0.4, .rise = 0.2, .decay_speed = 0.5};
  for (SquealOptions* options : {&falling, &by_table}) {
    options->pads.front().area = 1e-3;
    options->pads.front().radius = 2e-3;
    options->pads.front().shim = Shim{.stiffness = 4e7, .loss_factor = 0.2, .frequency_Hz = 2e3};
    PadPair other = options->pads.front();
    other.angle = 2.0;
    other.friction.reset();
    other.grid.reset();  // whose points would have no radius
    options->pads.push_back(other);
  }
  SquealOptions planes = full_options();
  planes.planes = ContactPlanes{.heights = {{-0.011, 0.01}}};
  planes.thickness = 0.021;
  return {FlexibleDisc(disc, falling), FlexibleDisc(disc, by_table),
          FlexibleDisc(make_disc(linked_body({kirchhoff_2(), kirchhoff_3()}, {0.003}),
                                 ring_choice(on_rings(planes, "ring 1", *planes.planes)), {}),
                       on_rings(planes, "ring 1", *planes.planes))};
}

TEST(Parameters, OfABodyChangeItsStateMatrix)
{
  const std::vector<FlexibleDisc> brakes = brakes_of_a_body();
  int n = 0;
  for (const ParameterRow& row : parameters) {
    if (row.of != ParameterOf::body && row.of != ParameterOf::any) continue;
    if (row.name == "pads.angle_deg") continue;  // of one of several pads: the next tests
    const double value = row.name == "friction" ? 0.3 : row.name.ends_with("static") ? 0.9 : 0.07;
    double change = 0.0;
    for (const FlexibleDisc& brake : brakes) {
      if (!complaint_of_value(brake, {row.name}, value).empty()) continue;
      const Eigen::MatrixXd A = brake.state_matrix(8.0);
      const Eigen::MatrixXd changed = brake.with({row.name}, value)->state_matrix(8.0);
      // Modes of the pads come with any sign: their spectra are compared.
      change = std::max(change, (changed.eigenvalues() - A.eigenvalues()).norm() / A.norm());
    }
    EXPECT_GT(change, 1e-9) << row.name;
    ++n;
  }
  EXPECT_EQ(n, 46);
}

TEST(Parameters, OfABrakeAreThoseThatItsSceneGives)
{
  std::vector<std::string> keys;
  for (const ParameterValue& one : brakes_of_a_body()[1].parameters())
    keys.push_back(key_of(one.parameter));
  const auto has = [&](const char* key) { return std::ranges::find(keys, key) != keys.end(); };
  for (const char* key :
       {"friction.factor", "friction.temperature_C", "thickness", "pads[1].friction.static",
        "pads[2].angle_deg", "pads[2].shim.stiffness", "pads[1].body.about_axial.inertia"})
    EXPECT_TRUE(has(key)) << key;
  for (const char* key : {"friction", "friction.static", "pads[2].friction", "contact_planes[1]",
                          "pads[1].friction.factor"})
    EXPECT_FALSE(has(key)) << key;
  for (const ParameterValue& one : brakes_of_a_body()[1].parameters()) {
    if (key_of(one.parameter) != "pads[2].angle_deg") continue;
    EXPECT_NEAR(one.value, 2.0 * 180.0 / pi, 1e-12);
  }
}

TEST(Parameters, OfTheKineticCoefficientLeaveTheStaticOne)
{
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), full_options());
  SquealOptions options = full_options();
  options.friction.kinetic = 0.5;
  options.friction.rise = 0.6 - 0.5;
  EXPECT_EQ(brake.with({"friction.kinetic"}, 0.5)->state_matrix(8.0),
            FlexibleDisc(disc_of({kirchhoff_3()}), options).state_matrix(8.0));
  options.friction.kinetic = 0.7;
  options.friction.rise = (0.4 + 0.2) - 0.7;
  EXPECT_EQ(brake.with({"friction.kinetic"}, 0.7)->state_matrix(8.0),
            FlexibleDisc(disc_of({kirchhoff_3()}), options).state_matrix(8.0));
}

TEST(Parameters, AreThoseOfTheScene)
{
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), full_options());
  const auto same = [&](std::string_view name, double value, const auto& change) {
    SquealOptions options = full_options();
    change(options);
    EXPECT_EQ(brake.with({name}, value)->state_matrix(8.0),
              FlexibleDisc(disc_of({kirchhoff_3()}), options).state_matrix(8.0))
        << name;
  };
  same("damping", 9.0, [](auto& o) { o.pads[0].damping = 9.0; });
  same("friction.static", 0.7, [](auto& o) { o.friction.rise = 0.7 - 0.4; });
  same("thickness", 0.03, [](auto& o) { o.thickness = 0.03; });
  same("pads.grid.sector_deg", 30.0, [](auto& o) { o.pads[0].grid->sector = 30.0 * (pi / 180.0); });
  same("pads.body.mass", 0.5, [](auto& o) { o.pads[0].body->mass = 0.5; });
  same("pads.body.tangential.damping", 7.0,
       [](auto& o) { o.pads[0].body->tangential->damping = 7.0; });
  same("pads.body.about_axial.inertia", 3e-4,
       [](auto& o) { o.pads[0].body->about_axial->inertia = 3e-4; });
  same("pads.caliper.stiffness", 5e6, [](auto& o) { o.pads[0].caliper->axial.stiffness = 5e6; });
}

TEST(Parameters, OfOnePadLeaveTheOthersAsTheyAre)
{
  SquealOptions two = full_options();
  two.pads.push_back({.angle = 1.0, .stiffness = 4e6, .damping = 2.0, .preload = 1500.0});
  const FlexibleDisc brake(disc_of({kirchhoff_2(), kirchhoff_3()}), two);
  const auto same = [&](std::string_view key, double value, const auto& change) {
    SquealOptions options = two;
    change(options.pads);
    const auto parameter = parameter_of(key);
    ASSERT_TRUE(parameter) << key;
    EXPECT_EQ(key_of(*parameter), key);
    const auto changed = brake.with(*parameter, value)->state_matrix(8.0);
    EXPECT_EQ(changed,
              FlexibleDisc(disc_of({kirchhoff_2(), kirchhoff_3()}), options).state_matrix(8.0))
        << key;
    EXPECT_NE(changed, brake.state_matrix(8.0)) << key;
  };
  same("pads[2].stiffness", 7e6, [](auto& pads) { pads[1].stiffness = 7e6; });
  same("pads[1].preload", 900.0, [](auto& pads) { pads[0].preload = 900.0; });
  same("pads[2].angle_deg", 120.0, [](auto& pads) { pads[1].angle = 120.0 * (pi / 180.0); });
  same("pads[1].body.mass", 0.5, [](auto& pads) { pads[0].body->mass = 0.5; });
}

TEST(Parameters, OfPadsThatAreNotThereAreRefused)
{
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), full_options());
  EXPECT_NE(
      complaint_of_value(brake, {"stiffness", 2}, 1e6).find("\"pads[2].stiffness\" cannot vary"),
      std::string::npos);
  EXPECT_NE(complaint_of_value(brake, {"pads.angle_deg"}, 10.0).find("pads[2].angle_deg"),
            std::string::npos);
  for (const std::string_view key :
       {"pads[0].stiffness", "pads[x].stiffness", "pads[1].rubbing", "pads[1]", "pads[1].",
        "pads[99999999999].stiffness", "pads.stiffness", "pads[1].pads.body.mass"})
    EXPECT_FALSE(parameter_of(key)) << key;
}

TEST(Parameters, ThatABrakeLacksAreNamed)
{
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), reference_options());
  EXPECT_EQ(complaint_of_value(brake, MapParameter::damping, 1.0), "");
  const std::string text = complaint_of_value(brake, {"pads.body.mass"}, 0.3);
  EXPECT_NE(text.find("\"pads.body.mass\" cannot vary"), std::string::npos) << text;
  EXPECT_NE(complaint_of_value(brake, {"friction.static"}, 0.9), "");  // Coulomb's law has none
  // "friction" moves all of mu, here with a static coefficient 0.2 below the kinetic one.
  SquealOptions rising = full_options();
  rising.friction.rise = -0.2;
  const FlexibleDisc brake_of_rising(disc_of({kirchhoff_3()}), rising);
  EXPECT_EQ(complaint_of_value(brake_of_rising, MapParameter::friction, 0.3), "");
  EXPECT_NE(complaint_of_value(brake_of_rising, MapParameter::friction, 0.1)
                .find("begin the range at 0.2"),
            std::string::npos);
}

TEST(Parameters, HaveATableOfAllModes)
{
  // Over the mass of the plates, and over the damping of the pads from zero on.
  const FlexibleDisc brake(disc_of({kirchhoff_2(), kirchhoff_3()}), full_options());
  for (const auto& [name, from, to] :
       {std::tuple{"pads.body.mass", 0.1, 0.9}, {"damping", 0.0, 200.0}}) {
    const StabilityCase search{
        .over = MapParameter{name}, .from = from, .to = to, .count = 5, .speed = 20.0};
    const StabilityTable table = unstable_modes(brake, search);
    EXPECT_EQ(table.parameter, name);
    for (Eigen::Index i = 0; i < 5; ++i) {
      const auto exact =
          oscillating_eigenvalues(brake.with({name}, table.values[i])->state_matrix(20.0));
      ASSERT_EQ(exact.size(), std::ssize(table.branches));
      for (const StabilityBranch& branch : table.branches) {
        EXPECT_LT((exact.array() - branch.lambda[i]).abs().minCoeff(),
                  1e-9 * std::abs(branch.lambda[i]));
      }
    }
  }
}

/// A picture of 12 rings of 48 points between r = 0.05 and 0.16, and integrals over the mass.
mbs_export::ModalBody pictured_body(double circle, double in_plane)
{
  mbs_export::ModalBody body = analytic_body({kirchhoff_3()});
  body.picture.positions.resize(12 * 48, 3);
  body.picture.transformation = Eigen::MatrixXd::Zero(3 * 12 * 48, 2);
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 48; ++j) {
      const double r = 0.05 + 0.01 * i, theta = 2.0 * pi * j / 48.0;
      const Eigen::Index at = 48 * i + j;
      body.picture.positions.row(at) << r * std::cos(theta), r * std::sin(theta), 0.0;
      body.picture.transformation.row(3 * at + 2) << (r - circle) * std::cos(3.0 * theta),
          (r - circle) * std::sin(3.0 * theta);
    }
  body.mass_integrals = mbs_export::MassIntegrals{};
  body.mass_integrals->displacement = Eigen::MatrixXd::Zero(3, 2);
  for (Eigen::MatrixXd& S : body.mass_integrals->products) S = Eigen::MatrixXd::Zero(2, 2);
  body.mass_integrals->products[0] = 0.5 * in_plane * Eigen::Matrix2d::Identity();
  body.mass_integrals->products[1] = 0.5 * in_plane * Eigen::Matrix2d::Identity();
  body.mass_integrals->products[2] = (1.0 - in_plane) * Eigen::Matrix2d::Identity();
  return body;
}

StabilityTable table_of(const mbs_export::ModalBody& body)
{
  const FlexibleDisc brake(disc_on_ring(body, "track", {}), reference_options());
  return unstable_modes(brake, {.from = 10.0, .to = 20.0, .count = 2});
}

TEST(ModeFigures, CountCirclesAndTellMotionInThePlane)
{
  const StabilityTable one = table_of(pictured_body(0.1, 0.2));
  ASSERT_FALSE(one.branches.empty());
  EXPECT_EQ(nodal_circles(one, one.branches.front()), 1);
  EXPECT_NEAR(in_plane_share(one, one.branches.front()).value(), 0.2, 1e-12);
  const StabilityTable none = table_of(pictured_body(0.0, 0.2));
  EXPECT_EQ(nodal_circles(none, none.branches.front()), 0);
  // Of motion in the plane nodal circles say nothing; a body may have no picture and no integrals.
  const StabilityTable flat = table_of(pictured_body(0.1, 0.9));
  EXPECT_FALSE(nodal_circles(flat, flat.branches.front()));
  const StabilityTable bare = table_of(analytic_body({kirchhoff_3()}));
  EXPECT_FALSE(nodal_circles(bare, bare.branches.front()));
  EXPECT_FALSE(in_plane_share(bare, bare.branches.front()));
}

}  // namespace
}  // namespace chladni::squeal
