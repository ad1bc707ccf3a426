// Loss factors, measured damping and friction, shims and programs as the scene gives them.
#include <gtest/gtest.h>

#include <string>

#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using test::error_of;
using test::replaced;

const std::string damped_disc = R"([mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_size = 0.01
rings = [{ name = "track", radius = 0.13, nodes = 60 }]
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["track", "hub"]
[reduce]
method = "guyan"
[body]
fixed = ["hub"]
[squeal]
ring = "track"
thickness = 0.02
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 60 }
analyses = ["eigenvalues"]
transient = { speed_rad_s = 20.0, duration_s = 1.0, initial_pad_displacement = 1e-6 }
friction = 0.6
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 1.0, preload = 2000.0 }]
)";

Scene scene_with(const std::string& text)
{
  return parse_scene(text, "scene.toml");
}

TEST(LossFactorsOfAScene, AreThoseOfMaterialSectionAndSpring)
{
  EXPECT_EQ(scene_with(damped_disc).body.damping.type, mbs_export::Damping::Type::none);
  const std::string lossy =
      replaced(damped_disc, "density = 6300.0", "density = 6300.0\nloss_factor = 0.01");
  const Scene scene = scene_with(lossy);
  EXPECT_EQ(scene.sections[0].material.loss_factor, 0.01);
  EXPECT_FALSE(scene.sections[0].loss_factor);
  EXPECT_EQ(scene.body.damping.type, mbs_export::Damping::Type::matrix);
  const std::string section =
      replaced(lossy, "thickness = 0.02\n", "thickness = 0.02\nloss_factor = 0.0\n");
  EXPECT_EQ(scene_with(section).sections[0].loss_factor, 0.0);
  EXPECT_EQ(scene_with(section).body.damping.type, mbs_export::Damping::Type::none);
  const std::string spring = replaced(damped_disc, "[interface]",
                                      "[[spring]]\nat = \"hub\"\nstiffness = { z = 1e6 }\n"
                                      "loss_factor = 0.3\n[interface]");
  EXPECT_EQ(scene_with(spring).springs[0].loss_factor, 0.3);
  EXPECT_EQ(scene_with(spring).body.damping.type, mbs_export::Damping::Type::matrix);
  EXPECT_EQ(error_of(replaced(lossy, "loss_factor = 0.01", "loss_factor = -0.01")),
            "scene.toml:11: material.iron.loss_factor = -0.01: must be >= 0");
}

TEST(MeasuredRatios, AreATableOverTheFrequency)
{
  const auto with = [](const std::string& ratio) {
    return replaced(damped_disc, "fixed = [\"hub\"]",
                    "fixed = [\"hub\"]\ndamping = { type = \"modal\", ratio = " + ratio + " }");
  };
  const Scene scene = scene_with(with("{ at_Hz = [100, 2000], values = [1e-3, 2e-3] }"));
  EXPECT_EQ(scene.body.damping.at_Hz, (std::vector{100.0, 2000.0}));
  EXPECT_EQ(scene.body.damping.ratios, (std::vector{1e-3, 2e-3}));
  EXPECT_TRUE(error_of(with("{ at_Hz = [100, 2000], values = [1e-3] }"))
                  .ends_with("must be as many as the numbers of at_Hz"));
  EXPECT_TRUE(error_of(with("{ at_Hz = [2000, 100], values = [1e-3, 1e-3] }"))
                  .ends_with("must be larger than the one before"));
  EXPECT_TRUE(error_of(with("{ at_Hz = [100], values = [1e-3] }"))
                  .ends_with("must hold at least two frequencies"));
}

std::string with_table(const std::string& rows, const std::string& more = "")
{
  return replaced(damped_disc, "friction = 0.6",
                  "friction = { " + more + "table = [" + rows + "] }");
}

const std::string hot =
    "{ temperature_C = 200, pressure_Pa = 1e6, speed_m_s = [0.1, 5], mu = [0.4, 0.3] }";
const std::string cold =
    "{ temperature_C = 100, pressure_Pa = 1e6, speed_m_s = [0.1, 5], mu = [0.5, 0.6] }";

TEST(MeasuredFriction, HasACurveAtEachPressureOfEachTemperature)
{
  const Scene scene =
      scene_with(with_table(hot + ", " + cold, "temperature_C = 150.0, factor = 1.1, "));
  const squeal::FrictionLaw& law = scene.squeal->friction;
  ASSERT_TRUE(law.table);
  EXPECT_EQ(law.kinetic, 1.1);
  EXPECT_EQ(law.temperature, 150.0);
  EXPECT_EQ(law.table->temperatures, (std::vector{100.0, 200.0}));
  ASSERT_EQ(law.table->curves.size(), 2u);
  EXPECT_EQ(law.table->curves[0].mu, (std::vector{0.5, 0.6}));
  EXPECT_NEAR(squeal::friction_coefficient(law, 5.0, 1e6), 1.1 * 0.45, 1e-12);
}

TEST(MeasuredFriction, NeedsNoTemperatureOrNoPressure)
{
  const std::string low = "{ pressure_Pa = 1e6, speed_m_s = [0.1, 5], mu = [0.4, 0.3] }",
                    high = "{ pressure_Pa = 3e6, speed_m_s = [0.1, 5], mu = [0.2, 0.2] }";
  const squeal::FrictionLaw of_pressures =
      scene_with(with_table(low + ", " + high)).squeal->friction;
  ASSERT_EQ(of_pressures.table->curves.size(), 2u);
  EXPECT_NEAR(squeal::friction_coefficient(of_pressures, 5.0, 2e6), 0.25, 1e-12);
  const std::string either =
      replaced(hot, "pressure_Pa = 1e6, ", "") + ", " + replaced(cold, "pressure_Pa = 1e6, ", "");
  const squeal::FrictionLaw of_temperatures =
      scene_with(with_table(either, "temperature_C = 150.0, ")).squeal->friction;
  ASSERT_EQ(of_temperatures.table->curves.size(), 2u);
  EXPECT_NEAR(squeal::friction_coefficient(of_temperatures, 5.0, 7e6), 0.45, 1e-12);
}

TEST(MeasuredFriction, IsRefusedWithTheKeyAndTheRange)
{
  const std::string both = hot + ", " + cold;
  const auto expect = [](const std::string& text, const std::string& said) {
    const std::string error = error_of(text);
    EXPECT_NE(error.find(said), std::string::npos) << error;
    EXPECT_TRUE(error.starts_with("scene.toml:")) << error;
  };
  expect(with_table(both, "temperature_C = 250.0, "),
         "squeal.friction.temperature_C = 250: must be >= 100 and <= 200");
  expect(with_table(both), "squeal.friction.temperature_C is missing");
  expect(with_table(both, "temperature_C = 150.0, kinetic = 0.4, "), "take this key out");
  expect(with_table(hot + ", " + hot, "temperature_C = 200.0, "), "it has 2");
  expect(with_table(hot + ", " + replaced(cold, "1e6", "2e6"), "temperature_C = 150.0, "),
         "it has 0");
  expect(with_table(replaced(hot, "[0.1, 5]", "[5, 0.1]"), "temperature_C = 200.0, "),
         "must be larger than the one before");
  expect(with_table(replaced(hot, "[0.4, 0.3]", "[0.4]"), "temperature_C = 200.0, "),
         "must be as many as the numbers of speed_m_s");
  expect(with_table(hot + ", { speed_m_s = [0.1, 5], mu = [0.4, 0.3] }", "temperature_C = 200.0, "),
         "all rows of the table need temperature_C, or none");
  expect(with_table(replaced(hot, "0.4", "-0.4"), "temperature_C = 200.0, "), "must be >= 0");
}

TEST(FrictionOfAPad, IsItsOwn)
{
  const std::string own = replaced(damped_disc, "preload = 2000.0",
                                   "preload = 2000.0, area = 2e-3, friction = { kinetic = 0.3, "
                                   "static = 0.4, decay_speed = 1.0 }");
  const Scene scene = scene_with(own);
  EXPECT_EQ(scene.squeal->pads[0].friction->kinetic, 0.3);
  EXPECT_EQ(scene.squeal->pads[0].area, 2e-3);
  EXPECT_FALSE(scene.squeal->pads[0].radius);
  EXPECT_EQ(scene.squeal->friction.kinetic, 0.6);
}

TEST(FaceOfAPad, IsRoundOrAPointByName)
{
  const auto with = [](const std::string& face) {
    return replaced(damped_disc, "preload = 2000.0", "preload = 2000.0, " + face);
  };
  EXPECT_FALSE(scene_with(damped_disc).squeal->pads[0].radius);
  EXPECT_EQ(scene_with(with("radius = 0.02")).squeal->pads[0].radius, 0.02);
  const squeal::PadPair point = scene_with(with("area = 1e-3, face = \"point\"")).squeal->pads[0];
  EXPECT_EQ(point.radius, 0.0);
  EXPECT_EQ(point.area, 1e-3);
  EXPECT_FALSE(scene_with(with("area = 1e-3, face = \"round\"")).squeal->pads[0].radius);
  const auto expect = [&](const std::string& face, const std::string& part) {
    EXPECT_NE(error_of(with(face)).find(part), std::string::npos) << error_of(with(face));
  };
  expect("face = \"square\"", "must be one of \"round\", \"point\"");
  expect("face = \"round\"", "give `radius` or `area`");
  expect("radius = 0.02, face = \"point\"", "leave out one of them");
  expect("grid = { sector_deg = 20.0, points = 2 }, face = \"point\"", "leave out one of them");
}

TEST(ShimOfAPad, IsBehindItsPlate)
{
  const std::string shim =
      replaced(damped_disc, "preload = 2000.0",
               "preload = 2000.0, shim = { stiffness = 4e7, loss_factor = 0.3, "
               "frequency_Hz = 1700.0 }");
  EXPECT_EQ(scene_with(shim).squeal->pads[0].shim->loss_factor, 0.3);
  EXPECT_NE(error_of(replaced(shim, "shim =",
                              "body = { mass = 0.3, radial = { stiffness = 1e6, "
                              "damping = 0.0 } }, shim ="))
                .find("give body.axial"),
            std::string::npos);
  EXPECT_NE(error_of(replaced(shim, "frequency_Hz = 1700.0", "frequency_Hz = 0.0"))
                .find("squeal.pads.shim.frequency_Hz = 0: must be > 0 (Hz)"),
            std::string::npos);
}

TEST(PreloadProgramOfAScene, AscendsInTime)
{
  const auto with = [](const std::string& points) {
    return replaced(damped_disc, "initial_pad_displacement = 1e-6",
                    "initial_pad_displacement = 1e-6, preload_program = [" + points + "]");
  };
  const Scene scene = scene_with(with("{ t_s = 0.0, factor = 0.1 }, { t_s = 0.5, factor = 1.0 }"));
  ASSERT_EQ(scene.squeal->study.transient->preload_program.size(), 2u);
  EXPECT_EQ(scene.squeal->study.transient->preload_program[1].factor, 1.0);
  EXPECT_FALSE(scene.squeal->study.transient->is_constant());
  EXPECT_NE(error_of(with("{ t_s = 0.5, factor = 0.1 }, { t_s = 0.5, factor = 1.0 }"))
                .find("t_s = 0.5: must be > 0.5"),
            std::string::npos);
  EXPECT_NE(error_of(with("{ t_s = 0.0, factor = -0.1 }")).find("factor = -0.1: must be >= 0"),
            std::string::npos);
  EXPECT_NE(error_of(with("")).find("must hold at least one point"), std::string::npos);
}

TEST(AsymmetryOfAScene, IsAveragedOrKept)
{
  EXPECT_FALSE(scene_with(damped_disc).squeal->keeps_asymmetry);
  EXPECT_TRUE(
      scene_with(replaced(damped_disc, "friction = 0.6", "friction = 0.6\nasymmetry = \"kept\""))
          .squeal->keeps_asymmetry);
}

TEST(GradientsOfAScene, HaveASpeed)
{
  const std::string asked = replaced(damped_disc, "[\"eigenvalues\"]", "[\"gradients\"]");
  EXPECT_FALSE(scene_with(asked).squeal->study.gradients);
  const std::string at =
      replaced(asked, "friction = 0.6", "friction = 0.6\ngradients = { speed_rad_s = 20.0 }");
  EXPECT_EQ(scene_with(at).squeal->study.gradients->speed, 20.0);
}

}  // namespace
}  // namespace chladni::scene
