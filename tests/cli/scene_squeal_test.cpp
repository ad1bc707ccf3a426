#include <gtest/gtest.h>

#include <numbers>

#include "scene_texts.hpp"

namespace chladni::cli {
namespace {

using testing::disc;
using testing::error_of;
using testing::oscillator;
using testing::replaced;
using testing::rigid_disc;

TEST(Scene, HoldsTheSquealStudyInRadians)
{
  const Scene scene = parse_scene(disc, "scene.toml");
  ASSERT_TRUE(scene.squeal);
  EXPECT_EQ(scene.squeal->thickness, 0.03);
  EXPECT_EQ(scene.squeal->modes.nodal_diameters, 3);
  EXPECT_EQ(scene.squeal->contact, squeal::ContactLaw::bilateral);
  ASSERT_EQ(scene.squeal->pads.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.squeal->pads[0].angle, std::numbers::pi / 2.0);
  ASSERT_TRUE(scene.squeal->growth);
  EXPECT_EQ(scene.squeal->growth->speeds, (std::vector<double>{12.0, 13.0}));
  ASSERT_TRUE(scene.squeal->transient);
  EXPECT_EQ(scene.squeal->transient->steps_per_period, std::nullopt);
  EXPECT_EQ(scene.squeal->transient->integrator, squeal::IntegratorKind::automatic);
}

TEST(Scene, TakesTheSpeedOfALimitCycleFromTheTransientUnlessGiven)
{
  EXPECT_EQ(parse_scene(disc, "scene.toml").squeal->limit_cycle_direct->speed, 19.0);
  const Scene scene =
      parse_scene(disc + "limit_cycle_direct = { speed_rad_s = 20.0 }\n", "scene.toml");
  EXPECT_EQ(scene.squeal->limit_cycle_direct->speed, 20.0);
}

TEST(Scene, HoldsTheSecondParameterOfAStabilityMap)
{
  EXPECT_FALSE(parse_scene(disc, "scene.toml").squeal->map);
  const std::string map =
      "map = { parameter = \"stiffness\", from = 1e6, to = 9e6, count = 100 }\n";
  const Scene scene = parse_scene(disc + map, "scene.toml");
  ASSERT_TRUE(scene.squeal->map);
  EXPECT_TRUE(scene.squeal->critical.empty());
  EXPECT_FALSE(scene.squeal->sound);
  EXPECT_EQ(scene.squeal->map->parameter, squeal::MapParameter::stiffness);
  EXPECT_EQ(scene.squeal->map->from, 1e6);
  EXPECT_EQ(scene.squeal->map->to, 9e6);
  EXPECT_EQ(scene.squeal->map->count, 100);
}

TEST(SceneError, NamesWhatAStabilityMapCannotBe)
{
  const std::string map =
      "map = { parameter = \"stiffness\", from = 1e6, to = 9e6, count = 100 }\n";
  EXPECT_EQ(error_of(disc + replaced(map, "stiffness", "speed")),
            "scene.toml:43: squeal.map.parameter = \"speed\": must be one of \"friction\", "
            "\"preload\", \"stiffness\"");
  EXPECT_EQ(error_of(disc + replaced(map, "to = 9e6", "to = 9e5")),
            "scene.toml:43: squeal.map.to = 900000: must be >= 1000000");
  EXPECT_EQ(error_of(replaced(disc, "\"growth\", ", "\"stability-map\", ")),
            "scene.toml:40: squeal.analyses = [ 'eigenvalues', 'stability-map', 'transient' ]: "
            "\"stability-map\" needs the key map");
}

TEST(SceneError, NamesWhatAnIntegratorACriticalValueOrASoundLacks)
{
  const auto with = [](const std::string& lines) { return error_of(disc + lines + "\n"); };
  EXPECT_EQ(error_of(replaced(disc, "7e-8 }", "7e-8, integrator = \"euler\" }")),
            "scene.toml:41: squeal.transient.integrator = \"euler\": must be one of \"auto\", "
            "\"splitting\", \"exponential\", \"dormand-prince\", \"generalised-alpha\"");
  EXPECT_EQ(with("wav = { rate_Hz = 100 }"),
            "scene.toml:43: squeal.wav.rate_Hz = 100: must be >= 8000 and <= 192000 (Hz)");
  EXPECT_EQ(
      with("critical = [{ parameter = \"preload\", from = 2.0, to = 1.0, speed_rad_s = 19.0 }]"),
      "scene.toml:43: squeal.critical.to = 1: must be > 2 (from)");
  EXPECT_EQ(error_of(replaced(disc, "\"growth\", \"transient\"]", "\"critical-values\"]")),
            "scene.toml:40: squeal.analyses = [ 'eigenvalues', 'critical-values' ]: "
            "\"critical-values\" needs the key critical");
}

TEST(Scene, ReadsARigidDiscWithoutMeshAndBody)
{
  const Scene scene = parse_scene(rigid_disc, "scene.toml");
  EXPECT_FALSE(scene.squeal);
  ASSERT_TRUE(scene.squeal_model);
  const auto& study = std::get<squeal::RigidDiscStudy>(scene.squeal_model->model);
  EXPECT_EQ(study.disc.Theta, 0.16);
  EXPECT_EQ(study.disc.spring.cubic, 1e13);
  EXPECT_EQ(study.disc.friction.kinetic, 0.4);
  EXPECT_DOUBLE_EQ(study.disc.friction.rise, 0.2);
  EXPECT_EQ(study.disc.friction.decay_speed, 0.5);
  EXPECT_EQ(study.drive, squeal::Drive::speed);
  EXPECT_EQ(study.equations, squeal::RigidEquations::nonlinear);
  EXPECT_EQ(study.disc.law, squeal::ContactLaw::unilateral);
  EXPECT_EQ(scene.squeal_model->growth->duration, 3.0);
}

TEST(Scene, ReadsAnOscillator)
{
  const Scene scene = parse_scene(oscillator, "scene.toml");
  const auto& study = std::get<squeal::Oscillator>(scene.squeal_model->model);
  EXPECT_EQ(study.k_xy, 1e6);
  EXPECT_EQ(study.d_y, 6.0);
  EXPECT_EQ(study.friction.kinetic, 0.3);
}

TEST(Scene, ReadsPadsWithAGridABodyAndACaliper)
{
  const std::string pads =
      "pads = [{ angle_deg = 90.0, stiffness = 6e6, damping = 1.0, preload = 2000.0, "
      "grid = { sector_deg = 40.0, points = 5 }, "
      "body = { mass = 0.4, height = 0.01, axial = { stiffness = 1e7, damping = 3.0 }, "
      "about_radial = { inertia = 2e-4, stiffness = 2e3, damping = 0.1 } }, "
      "caliper = { mass = 3.0, axial = 1 } }]";
  const std::string plain =
      "pads = [{ angle_deg = 90.0, stiffness = 6e6, damping = 1.0, preload = 2000.0 }]";
  const std::string good = replaced(pads, "axial = 1 }", "stiffness = 1e6, damping = 0.0 }");
  const Scene scene = parse_scene(replaced(disc, plain, good), "scene.toml");
  const squeal::PadPair& pad = scene.squeal->pads.at(0);
  EXPECT_DOUBLE_EQ(pad.grid->sector, std::numbers::pi * 2.0 / 9.0);
  EXPECT_EQ(pad.grid->points, 5);
  EXPECT_EQ(pad.body->axial->stiffness, 1e7);
  EXPECT_EQ(pad.body->about_radial->inertia, 2e-4);
  EXPECT_FALSE(pad.body->tangential);
  EXPECT_EQ(pad.caliper->axial.stiffness, 1e6);
  const auto error_after = [&](const std::string& from, const std::string& to) {
    return error_of(replaced(disc, plain, replaced(good, from, to)));
  };
  EXPECT_EQ(error_after("points = 5", "points = 0"),
            "scene.toml:39: squeal.pads.grid.points = 0: must be >= 1");
  EXPECT_EQ(error_after("sector_deg = 40.0", "sector_deg = 400.0"),
            "scene.toml:39: squeal.pads.grid.sector_deg = 400: must be > 0 and <= 360 (degrees)");
  EXPECT_EQ(error_after("mass = 0.4", "mass = 0.0"),
            "scene.toml:39: squeal.pads.body.mass = 0: must be > 0 (kg)");
  EXPECT_EQ(error_after("axial = { stiffness = 1e7", "axial = { stiffness = 0.0"),
            "scene.toml:39: squeal.pads.body.axial.stiffness = 0: must be > 0 (N/m)");
  EXPECT_EQ(error_after("inertia = 2e-4, ", ""),
            "scene.toml:39: squeal.pads.body.about_radial.inertia is missing: must be a number > 0 "
            "(kg m^2)");
  EXPECT_TRUE(error_after(", axial = { stiffness = 1e7, damping = 3.0 }", "")
                  .ends_with("carries the pads by their axial suspension: give body.axial"));
  EXPECT_TRUE(error_of(replaced(disc, plain,
                                replaced(plain, "preload = 2000.0",
                                         "preload = 2000.0, body = { mass = 1.0 }")))
                  .ends_with("about_radial, about_tangential or about_axial"));
}

TEST(Scene, ReadsASpeedProgramThatBeginsWithTheSpeedOfTheTransient)
{
  const auto with = [](const std::string& points) {
    return replaced(disc, "initial_pad_displacement = 7e-8",
                    "initial_pad_displacement = 7e-8, speed_program = " + points);
  };
  const Scene scene = parse_scene(
      with("[{ t_s = 1.0, speed_rad_s = 19.0 }, { t_s = 3.0, speed_rad_s = 0.0 }]"), "scene.toml");
  const auto& program = scene.squeal->transient->speed_program;
  ASSERT_EQ(program.size(), 3u);
  EXPECT_EQ(program[0].time, 0.0);
  EXPECT_EQ(program[0].speed, 19.0);
  EXPECT_EQ(program[2].speed, 0.0);
  EXPECT_EQ(error_of(with("[{ t_s = 1.0, speed_rad_s = 5.0 }, { t_s = 1.0, speed_rad_s = 0.0 }]")),
            "scene.toml:41: squeal.transient.speed_program[2].t_s = 1: must be > 1 (s)");
  EXPECT_EQ(error_of(with("[{ t_s = 1.0, speed_rad_s = -5.0 }]")),
            "scene.toml:41: squeal.transient.speed_program.speed_rad_s = -5: must be >= 0 (rad/s)");
  EXPECT_EQ(error_of(with("[]")),
            "scene.toml:41: squeal.transient.speed_program = []: must hold at least one point");
}

TEST(SceneError, NamesWhatAModelWithoutABodyCannotTake)
{
  const auto error_after = [](const std::string& scene, const std::string& from,
                              const std::string& to) {
    return error_of(replaced(scene, from, to));
  };
  EXPECT_EQ(error_after(rigid_disc, "\"rigid disc\"", "\"rigid disk\""),
            "scene.toml:3: squeal.model = \"rigid disk\": must be one of \"flexible disc\", "
            "\"rigid disc\", \"oscillator\"");
  EXPECT_EQ(error_after(rigid_disc, "axial_inertia = 0.32", "axial_inertia = 0.0"),
            "scene.toml:4: squeal.rigid_disc.axial_inertia = 0: must be > 0 (kg m^2)");
  EXPECT_EQ(error_after(rigid_disc, "static = 0.6", "static = 0.3"),
            "scene.toml:6: squeal.friction.static = 0.3: must be >= 0.4 (kinetic)");
  EXPECT_EQ(error_after(rigid_disc, ", decay_speed = 0.5", ""),
            "scene.toml:6: squeal.friction.decay_speed is missing: must be a number > 0 (m/s)");
  EXPECT_EQ(error_after(rigid_disc, "pad_radius = 0.13", "pad_radius = 0.13, drive = \"moment\""),
            "scene.toml:4: squeal.rigid_disc.drive = \"moment\": the constant moment 2 mu r_0 N_0 "
            "needs a constant friction coefficient");
  EXPECT_EQ(error_after(rigid_disc, "cubic_stiffness = 1e13", "cubic_stiffness = -1.0"),
            "scene.toml:7: squeal.pads.cubic_stiffness = -1: must be >= 0 (N/m^3)");
  EXPECT_TRUE(error_after(rigid_disc, "[{ stiffness", "[{ angle_deg = 3.0, stiffness")
                  .starts_with("scene.toml:7: squeal.pads.angle_deg is not a key here;"));
  EXPECT_TRUE(
      error_after(rigid_disc, "[\"eigenvalues\"", "[\"stability-map\"")
          .starts_with("scene.toml:9: squeal.analyses[1] = \"stability-map\": must be one "));
  EXPECT_TRUE(error_after(rigid_disc, "[squeal]", "[mesh]\nfile = \"a.msh\"\n[squeal]")
                  .starts_with("scene.toml:2: mesh is not a key here;"));
  EXPECT_EQ(error_after(oscillator, "stiffness_coupling = 1e6", "stiffness_coupling = 1e8"),
            "scene.toml:3: squeal.oscillator.stiffness_coupling = 100000000: its square must be "
            "below stiffness_along times stiffness_normal, or the springs do not hold the mass");
}

}  // namespace
}  // namespace chladni::cli
