#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include "scene/scene_text.hpp"

#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <sstream>

#include "squeal/study_options.hpp"
#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using test::error_of;
using test::replaced;

/// The thesis disc, short; the numbers of its lines stand in the tests below.
const std::string disc_scene = R"(title = "Disc"
[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_order = 3
element_size = 0.0078
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
method = "craig-bampton"
modes = 100
[body]
fixed = ["hub"]
keep = { modes = 40 }
interface_modes = [{ kind = "frm", at = "track", dofs = ["z"], omega0 = "auto" }]
damping = { type = "none" }
[squeal]
ring = "track"
thickness = 0.03
use_modes = "nodal-diameters 3"
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 60 }
friction = 0.6
contact = "bilateral"
pads = [{ angle_deg = 90.0, stiffness = 6e6, damping = 1.0, preload = 2000.0 }]
analyses = ["eigenvalues", "growth", "transient"]
transient = { speed_rad_s = 19.0, duration_s = 6.0, initial_pad_displacement = 7e-8 }
growth = { speeds_rad_s = [12.0, 13.0], duration_s = 0.3 }
)";

/// A change of the disc and the whole message that it must give.
struct Mistake {
  std::string old_part;
  std::string new_part;
  std::string message;
};

void expect_messages(const std::vector<Mistake>& mistakes)
{
  for (const Mistake& mistake : mistakes) {
    EXPECT_EQ(error_of(replaced(disc_scene, mistake.old_part, mistake.new_part)), mistake.message)
        << mistake.new_part;
  }
}

TEST(Scene, HoldsTheMeshAndItsSections)
{
  const Scene scene = parse_scene(disc_scene, "folder/scene.toml");
  ASSERT_TRUE(scene.mesh.annulus);
  EXPECT_EQ(scene.name, "disc");
  EXPECT_EQ(scene.title, "Disc");
  EXPECT_EQ(scene.text, disc_scene);
  EXPECT_EQ(scene.mesh.annulus->inner_radius, 0.025);
  EXPECT_EQ(scene.mesh.annulus->outer_radius, 0.162);
  EXPECT_EQ(scene.mesh.annulus->element_size, 0.0078);
  EXPECT_EQ(scene.mesh.annulus->element_order, 3);
  ASSERT_EQ(scene.mesh.annulus->rings.size(), 1u);
  EXPECT_EQ(scene.mesh.annulus->rings[0].radius, 0.13);
  EXPECT_EQ(scene.mesh.annulus->rings[0].nodes, 60);
  ASSERT_EQ(scene.sections.size(), 1u);
  EXPECT_EQ(scene.sections[0].material.young, 9e10);
  EXPECT_EQ(scene.sections[0].material.poisson, 0.3);
  EXPECT_EQ(scene.sections[0].material.density, 6300.0);
  EXPECT_EQ(scene.sections[0].thickness, 0.02);
  ASSERT_EQ(scene.couplings.size(), 1u);
  EXPECT_EQ(scene.couplings[0].group, "inner_edge");
}

TEST(Scene, HoldsTheHarmonicsOfRingsThatAreNodesOfTheInterface)
{
  const std::string nodes = "nodes = [\"track\", \"hub\"]\n";
  const auto with_rings = [&](const std::string& rings) {
    return replaced(disc_scene, nodes, nodes + "rings = " + rings + "\n");
  };
  const Scene scene =
      parse_scene(with_rings("[{ name = \"track\", harmonics = 5 }]"), "scene.toml");
  ASSERT_EQ(scene.ring_harmonics.size(), 1U);
  EXPECT_EQ(scene.ring_harmonics[0].ring, "track");
  EXPECT_EQ(scene.ring_harmonics[0].up_to, 5);
  const auto refused = [&](const std::string& rings, const std::string& why) {
    const std::string error = error_of(with_rings(rings));
    EXPECT_NE(error.find(why), std::string::npos) << error;
  };
  refused("[{ name = \"rim\", harmonics = 5 }]",
          "interface.rings.name = \"rim\": no such interface node");
  refused("[{ name = \"track\", harmonics = 31 }]", "a ring of 60 nodes has the harmonics 1 to 30");
  refused("[{ name = \"track\", harmonics = 5 }, { name = \"track\", harmonics = 4 }]",
          "is given twice");
}

TEST(Scene, HoldsTheReductionAndTheBody)
{
  const Scene scene = parse_scene(disc_scene, "scene.toml");
  EXPECT_EQ(scene.interface_nodes, (std::vector<std::string>{"track", "hub"}));
  EXPECT_EQ(scene.pictures, PictureChoice::vertices);
  EXPECT_EQ(scene.reduce.modes, 100);
  EXPECT_FALSE(scene.reduce.cutoff_Hz);
  EXPECT_EQ(scene.body.keep.count, 40);
  ASSERT_EQ(scene.body.interface_modes.size(), 1u);
  EXPECT_EQ(scene.body.interface_modes[0].components, std::vector<int>{2});
  EXPECT_FALSE(scene.body.interface_modes[0].omega0);
  EXPECT_EQ(scene.body.damping.type, mbs_export::Damping::Type::none);
}

TEST(Scene, HoldsTheToleranceOfTheBody)
{
  const Scene scene = parse_scene(
      replaced(disc_scene, "{ modes = 40 }", "{ tolerance = 1e-3, up_to_Hz = 8e3 }"), "scene.toml");
  ASSERT_TRUE(scene.body.keep.tolerance);
  EXPECT_EQ(scene.body.keep.tolerance->error, 1e-3);
  EXPECT_EQ(scene.body.keep.tolerance->up_to_Hz, 8e3);
  EXPECT_FALSE(scene.body.keep.up_to_Hz || scene.body.keep.count || scene.body.keep.list);
}

TEST(Scene, LeavesTheMethodOpenWhereAToleranceIsGiven)
{
  using reduce::Method;
  const auto method = [](const std::string& text) {
    return parse_scene(text, "scene.toml").reduce.method;
  };
  const std::string tolerance =
      replaced(disc_scene, "modes = 100", "tolerance = 1e-3\nup_to_Hz = 8e3");
  EXPECT_EQ(method(tolerance), Method::craig_bampton);  // as it says
  EXPECT_EQ(method(replaced(tolerance, "method = \"craig-bampton\"\n", "")), Method::automatic);
  EXPECT_EQ(method(replaced(tolerance, "craig-bampton", "auto")), Method::automatic);
  EXPECT_EQ(method(replaced(tolerance, "craig-bampton", "mixed-interface")),
            Method::mixed_interface);
  EXPECT_EQ(method(replaced(disc_scene, "craig-bampton", "mixed-interface")),
            Method::mixed_interface);
}

TEST(SceneError, NamesTheMethodThatSuitsTheChoiceOfModes)
{
  const std::string tolerance =
      replaced(disc_scene, "modes = 100", "tolerance = 1e-3\nup_to_Hz = 8e3");
  EXPECT_NE(
      error_of(replaced(disc_scene, "craig-bampton", "auto")).find("give tolerance and up_to_Hz"),
      std::string::npos);
  EXPECT_NE(
      error_of(replaced(disc_scene, "method = \"craig-bampton\"\n", "")).find("reduce.method"),
      std::string::npos);
  EXPECT_NE(error_of(replaced(tolerance, "craig-bampton", "rubin")).find("\"mixed-interface\""),
            std::string::npos);
}

TEST(SceneError, NeedsARangeForATolerance)
{
  expect_messages({
      {"{ modes = 40 }", "{ tolerance = 1e-3 }",
       "scene.toml:29: body.keep.up_to_Hz is missing: must be a number > 0 (Hz)"},
      {"{ modes = 40 }", "{ tolerance = 1.0, up_to_Hz = 8e3 }",
       "scene.toml:29: body.keep.tolerance = 1: must be > 0 and < 1"},
      {"{ modes = 40 }", "{ tolerance = 1e-3, up_to_Hz = 8e3, modes = 40 }",
       "scene.toml:29: body.keep.modes is not a key here; allowed: tolerance, up_to_Hz"},
  });
}

TEST(Scene, HoldsTheSquealStudyInRadians)
{
  const Scene scene = parse_scene(disc_scene, "scene.toml");
  ASSERT_TRUE(scene.squeal);
  EXPECT_EQ(scene.squeal->thickness, 0.03);
  EXPECT_EQ(scene.squeal->modes.nodal_diameters, 3);
  EXPECT_EQ(scene.squeal->contact, squeal::ContactLaw::bilateral);
  ASSERT_EQ(scene.squeal->pads.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.squeal->pads[0].angle, std::numbers::pi / 2.0);
  ASSERT_TRUE(scene.squeal->study.growth);
  EXPECT_EQ(scene.squeal->study.growth->speeds, (std::vector<double>{12.0, 13.0}));
  ASSERT_TRUE(scene.squeal->study.transient);
  EXPECT_EQ(scene.squeal->study.transient->steps_per_period, std::nullopt);
  EXPECT_EQ(scene.squeal->study.transient->integrator, squeal::IntegratorKind::automatic);
}

TEST(Scene, TakesSpeedsInAnyUnit)
{
  const std::string rad_s = "from_rad_s = 3.0, to_rad_s = 63.0";
  const auto speeds = [&](const std::string& words) {
    return parse_scene(replaced(disc_scene, rad_s, words), "scene.toml").squeal->study.speeds;
  };
  EXPECT_DOUBLE_EQ(speeds("from_rpm = 30, to_rpm = 600").from, std::numbers::pi);
  EXPECT_DOUBLE_EQ(speeds("from_rpm = 30, to_rpm = 600").to, 20.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(speeds("from_km_h = 3.6, to_rad_s = 63, wheel_radius = 0.25").from, 4.0);
  EXPECT_EQ(speeds("from_rad_s = 3, to_rad_s = 63, wheel_radius = 0.25").wheel_radius, 0.25);
  EXPECT_EQ(speeds(rad_s).wheel_radius, std::nullopt);
  expect_messages(
      {{rad_s, "from_rad_s = 3, to_rpm = 10",
        "scene.toml:36: squeal.speeds.to_rpm = 10: must be >= 28.64788975654116 (rpm)"},
       {rad_s, "from_rad_s = 3, to_rpm = 100, to_rad_s = 63",
        "scene.toml:36: squeal.speeds.to_rpm = 100: give exactly one of to_rad_s, to_rpm, to_km_h"},
       {rad_s, "from_km_h = 3, to_rad_s = 63",
        "scene.toml:36: squeal.speeds.wheel_radius is missing: must be a number > 0 (m)"}});
}

TEST(Scene, NotesNumbersThatLookLikeAnotherUnits)
{
  const auto note = [&](const std::string& old_part, const std::string& new_part) {
    const Scene scene = parse_scene(replaced(disc_scene, old_part, new_part), "scene.toml");
    return scene.notes.size() == 1 ? scene.notes[0] : "no single note";
  };
  EXPECT_TRUE(parse_scene(disc_scene, "scene.toml").notes.empty());
  EXPECT_TRUE(parse_scene(replaced(disc_scene, "9e10", "1.0"), "scene.toml").notes.empty());
  EXPECT_EQ(note("9e10", "110"),
            "scene.toml:10: material.iron.young = 110 is unusual: it is in Pa, and a steel has "
            "2.1e11");
  EXPECT_NE(note("6300.0", "7.2e-9").find("kg/m^3"), std::string::npos);
  EXPECT_NE(note("outer_radius = 0.162", "outer_radius = 12").find("in mm?"), std::string::npos);
  EXPECT_NE(note("thickness = 0.02", "thickness = 18").find("in mm?"), std::string::npos);
  EXPECT_NE(note("thickness = 0.03", "thickness = 18").find("in mm?"), std::string::npos);
  EXPECT_NE(note("friction = 0.6", "friction = 50").find("pure number"), std::string::npos);
  EXPECT_NE(note("to_rad_s = 63.0", "to_rad_s = 5e5").find("rpm"), std::string::npos);
}

TEST(Scene, TakesTheSpeedOfALimitCycleFromTheTransientUnlessGiven)
{
  EXPECT_EQ(parse_scene(disc_scene, "scene.toml").squeal->study.limit_cycle_direct->speed, 19.0);
  const Scene scene =
      parse_scene(disc_scene + "limit_cycle_direct = { speed_rad_s = 20.0 }\n", "scene.toml");
  EXPECT_EQ(scene.squeal->study.limit_cycle_direct->speed, 20.0);
}

TEST(Scene, HoldsWhatATableOfModesRunsOver)
{
  const auto stability = [](const std::string& words) {
    return *parse_scene(disc_scene + "stability = { " + words + " }\n", "scene.toml")
                .squeal->study.stability;
  };
  for (const std::string over : {"", ", over = \"speed\""}) {
    const squeal::StabilityCase of_speed = stability("band_Hz = [500, 1500]" + over);
    EXPECT_FALSE(of_speed.over);
    EXPECT_EQ(of_speed.from, 3.0);
    EXPECT_EQ(of_speed.to, 63.0);
    EXPECT_EQ(of_speed.band->to_Hz, 1500.0);
  }
  const squeal::StabilityCase of_stiffness =
      stability("over = \"stiffness\", from = 1e6, to = 9e6, count = 5, speed_rad_s = 20");
  EXPECT_EQ(of_stiffness.over, squeal::MapParameter::stiffness);
  EXPECT_EQ(of_stiffness.from, 1e6);
  EXPECT_EQ(of_stiffness.speed, 20.0);
}

TEST(Scene, HoldsTheSecondParameterOfAStabilityMap)
{
  EXPECT_FALSE(parse_scene(disc_scene, "scene.toml").squeal->study.map);
  const std::string map =
      "map = { parameter = \"stiffness\", from = 1e6, to = 9e6, count = 100 }\n";
  const Scene scene = parse_scene(disc_scene + map, "scene.toml");
  ASSERT_TRUE(scene.squeal->study.map);
  EXPECT_TRUE(scene.squeal->study.critical.empty());
  EXPECT_FALSE(scene.squeal->study.sound);
  EXPECT_EQ(scene.squeal->study.map->parameter, squeal::MapParameter::stiffness);
  EXPECT_EQ(scene.squeal->study.map->from, 1e6);
  EXPECT_EQ(scene.squeal->study.map->to, 9e6);
  EXPECT_EQ(scene.squeal->study.map->count, 100);
}

TEST(Scene, VariesAKeyOfOnePad)
{
  const std::string map =
      "map = { parameter = \"pads[2].stiffness\", from = 1e6, to = 9e6, count = 100 }\n";
  EXPECT_EQ(parse_scene(disc_scene + map, "scene.toml").squeal->study.map->parameter,
            (squeal::MapParameter{"stiffness", 2}));
  const std::string none =
      error_of(disc_scene + replaced(map, "pads[2].stiffness", "pads[2].rubbing"));
  EXPECT_NE(none.find("that of one pad alone is called like \"pads[1].stiffness\""),
            std::string::npos)
      << none;
}

TEST(SceneError, NamesWhatAStabilityMapCannotBe)
{
  const std::string map =
      "map = { parameter = \"stiffness\", from = 1e6, to = 9e6, count = 100 }\n";
  const std::string speed = error_of(disc_scene + replaced(map, "stiffness", "speed"));
  EXPECT_NE(speed.find("scene.toml:43: squeal.map.parameter = \"speed\": must be one of "
                       "\"friction\", \"preload\", \"stiffness\", \"damping\""),
            std::string::npos)
      << speed;
  EXPECT_EQ(speed.find("oscillator"), std::string::npos);  // no parameter of a disc
  EXPECT_EQ(error_of(disc_scene + replaced(map, "to = 9e6", "to = 9e5")),
            "scene.toml:43: squeal.map.to = 900000: must be >= 1000000");
  EXPECT_EQ(error_of(replaced(disc_scene, "\"growth\", ", "\"stability-map\", ")),
            "scene.toml:40: squeal.analyses = [ 'eigenvalues', 'stability-map', 'transient' ]: "
            "\"stability-map\" needs the key map");
}

TEST(Scene, TakesValuesInsteadOfDefaults)
{
  std::string text = replaced(disc_scene, "title = \"Disc\"", "name = \"rotor_1\"");
  text = replaced(text, "modes = 100", "cutoff_Hz = 16e3\npictures = \"none\"\nsylvester = true");
  text = replaced(text, "{ modes = 40 }", "{ list = [7, 8] }");
  text = replaced(text, "{ type = \"none\" }", "{ type = \"modal\", ratio = 0.001 }");
  text = replaced(text, "\"nodal-diameters 3\"", "[1, 2]");
  text = replaced(text, "7e-8 }",
                  "7e-8, steps_per_period = 80, "
                  "integrator = \"dormand-prince\", growth_error_1_s = 1e-4 }");
  text = replaced(text, "contact = \"bilateral\"\n", "");
  const Scene scene = parse_scene(text, "scene.toml");
  EXPECT_EQ(scene.name, "rotor_1");
  EXPECT_EQ(scene.title, "rotor_1");
  EXPECT_EQ(scene.reduce.cutoff_Hz, 16e3);
  EXPECT_FALSE(scene.reduce.modes);
  EXPECT_EQ(scene.pictures, PictureChoice::none);
  EXPECT_EQ(scene.sylvester, true);
  EXPECT_EQ(scene.body.keep.list, (std::vector<int>{7, 8}));
  EXPECT_EQ(scene.body.damping.ratios, std::vector<double>{0.001});
  EXPECT_EQ(scene.squeal->modes.list, (std::vector<int>{1, 2}));
  EXPECT_EQ(scene.squeal->study.transient->steps_per_period, 80);
  EXPECT_EQ(scene.squeal->study.transient->integrator, squeal::IntegratorKind::dormand_prince);
  EXPECT_EQ(scene.squeal->study.transient->growth_error, 1e-4);
  EXPECT_EQ(scene.squeal->contact, squeal::ContactLaw::unilateral);
}

TEST(Scene, SaysWhichMotionsStiffenTheBody)
{
  const auto with = [](const std::string& words) {
    return replaced(disc_scene, "[body]", "stiffening = [" + words + "]\n[body]");
  };
  EXPECT_TRUE(parse_scene(disc_scene, "scene.toml").stiffening.empty());
  EXPECT_EQ(parse_scene(with("\"spin-z\", \"acceleration\""), "scene.toml").stiffening,
            (std::vector<std::string>{"spin-z", "acceleration"}));
  EXPECT_NE(error_of(with("\"spin-w\"")).find("must be one of \"spin-x\""), std::string::npos);
  EXPECT_NE(error_of(with("\"spin\", \"spin\"")).find("is named twice"), std::string::npos);
  const std::string planar = replaced(with("\"spin\""), "[interface]",
                                      "[model]\ndofs = [\"z\", \"rx\", \"ry\"]\n[interface]");
  EXPECT_NE(error_of(planar).find("needs x, y and z in model.dofs"), std::string::npos)
      << error_of(planar);
}

TEST(Scene, SaysWhereInterfaceModesAndResultantsComeFrom)
{
  using Space = mbs_export::InterfaceModes::Space;
  const Scene scene = parse_scene(
      replaced(replaced(disc_scene, "omega0 = \"auto\" }", "omega0 = \"auto\", space = \"full\" }"),
               "[body]",
               "resultants = [\"disc\"]\nresultant_elements = [3, 4]\n"
               "mass_integrals = false\n[body]"),
      "scene.toml");
  EXPECT_EQ(scene.body.interface_modes[0].space, Space::full);
  EXPECT_EQ(scene.resultants.groups, std::vector<std::string>{"disc"});
  EXPECT_EQ(scene.resultants.elements, (std::vector<int>{3, 4}));
  EXPECT_FALSE(scene.mass_integrals);
  EXPECT_TRUE(parse_scene(disc_scene, "scene.toml").mass_integrals);
  EXPECT_NE(error_of(replaced(disc_scene,
                              "kind = \"frm\", at = \"track\", dofs = [\"z\"], omega0 = \"auto\"",
                              "kind = \"irm\", at = \"track\", dofs = [\"z\"], space = \"full\""))
                .find("holds every static response already"),
            std::string::npos);
}

TEST(SceneError, RefusesResponsesOfTheWholeModelInAFreeInterfaceReduction)
{
  const std::string full =
      replaced(disc_scene, "omega0 = \"auto\" }", "omega0 = \"auto\", space = \"full\" }");
  EXPECT_EQ(error_of(full), "no error");
  const std::string text = error_of(replaced(full, "craig-bampton", "rubin"));
  EXPECT_NE(text.find("space = \"full\": responses of the whole model"), std::string::npos) << text;
  EXPECT_NE(text.find("reduce with method \"craig-bampton\""), std::string::npos) << text;
  EXPECT_EQ(error_of(replaced(disc_scene, "craig-bampton", "rubin")), "no error");
}

TEST(SceneError, NamesRubinInPlaceOfMacNeal)
{
  const std::string text = error_of(replaced(disc_scene, "craig-bampton", "macneal"));
  EXPECT_NE(text.find("reduce.method = \"macneal\": MacNeal's method is gone"), std::string::npos)
      << text;
  EXPECT_NE(text.find("take \"rubin\""), std::string::npos) << text;
}

TEST(Scene, NeedsNeitherBodyNorSqueal)
{
  const Scene scene = parse_scene(disc_scene.substr(0, disc_scene.find("[body]")), "scene.toml");
  EXPECT_TRUE(scene.body.fixed.empty());
  EXPECT_FALSE(scene.body.keep.count);
  EXPECT_FALSE(scene.squeal);
}

TEST(Scene, FindsAMeshFileInItsOwnFolder)
{
  const std::size_t begin = disc_scene.find("generator");
  const std::string generator = disc_scene.substr(begin, disc_scene.find("rings") - begin);
  const std::string text = replaced(disc_scene, generator, "file = \"../mesh/disc.msh\"\n");
  const Scene scene = parse_scene(text, "cases/a/scene.toml");
  EXPECT_EQ(scene.mesh.file, "cases/mesh/disc.msh");
  EXPECT_FALSE(scene.mesh.annulus);
  EXPECT_EQ(scene.mesh.rings.size(), 1u);
}

TEST(Scene, OfTheExampleIsReadable)
{
  const Scene scene = read_scene(CHLADNI_SOURCE_DIR "/examples/thesis_disc/scene.toml");
  ASSERT_TRUE(scene.squeal && scene.squeal->study.transient && scene.squeal->study.growth);
  // Written with nine digits in the file.
  EXPECT_NEAR(scene.squeal->study.transient->speed, 6.0 * std::numbers::pi, 1e-7);
  EXPECT_NEAR(scene.squeal->study.growth->speeds.front(), 3.8 * std::numbers::pi, 1e-7);
  EXPECT_EQ(scene.squeal->contact, squeal::ContactLaw::bilateral);
}

TEST(Scene, TakesHillsMethodUnlessFloquetIsAskedFor)
{
  const std::string growth = "growth = { speeds_rad_s = [12.0, 13.0], duration_s = 0.3 }";
  const auto method_of = [&](const std::string& lines) {
    return parse_scene(replaced(disc_scene, growth, growth + lines), "scene.toml")
        .squeal->study.rotation_method;
  };
  EXPECT_EQ(method_of(""), squeal::RotationMethod::hill);
  EXPECT_EQ(method_of("\nrotation_stability = { method = \"hill\" }"),
            squeal::RotationMethod::hill);
  EXPECT_EQ(method_of("\nrotation_stability = { method = \"floquet\" }"),
            squeal::RotationMethod::floquet);
  const std::string error = error_of(
      replaced(disc_scene, growth, growth + "\nrotation_stability = { method = \"hil\" }"));
  EXPECT_NE(error.find("rotation_stability.method"), std::string::npos) << error;
  EXPECT_NE(error.find("floquet"), std::string::npos) << error;
}

/// The disc of the scene with a second ring.
std::string disc_with_two_rings()
{
  const std::string ring = "{ name = \"track\", radius = 0.13, nodes = 60 }";
  return replaced(
      replaced(disc_scene, ring, ring + ", { name = \"inner\", radius = 0.12, nodes = 60 }"),
      "nodes = [\"track\", \"hub\"]", "nodes = [\"track\", \"inner\", \"hub\"]");
}

TEST(Scene, NamesOneRingOrOneForEachContactPlane)
{
  const squeal::SquealOptions one = parse_scene(disc_scene, "scene.toml").squeal.value();
  EXPECT_FALSE(one.planes);
  const std::string two = replaced(disc_with_two_rings(), "ring = \"track\"",
                                   "ring = { inboard = \"inner\", outboard = \"track\" }");
  const squeal::SquealOptions faces = parse_scene(two, "scene.toml").squeal.value();
  EXPECT_EQ(faces.ring, "inner");
  EXPECT_EQ(faces.planes.value().opposite_ring, "track");
  EXPECT_FALSE(faces.planes->heights);
  EXPECT_EQ(faces.thickness, 0.03);
  const squeal::SquealOptions planes =
      parse_scene(replaced(disc_scene, "thickness = 0.03", "contact_planes = [-0.01, 0.015]"),
                  "scene.toml")
          .squeal.value();
  EXPECT_EQ(planes.planes.value().opposite_ring, "");
  EXPECT_EQ(planes.planes->heights.value(), (std::array{-0.01, 0.015}));
  EXPECT_DOUBLE_EQ(planes.thickness, 0.025);
  const std::string grid =
      "grid = { sector_deg = 20.0, points = 2, rings = [{ inboard = \"inner\", outboard = "
      "\"track\" }] }, angle_deg";
  const squeal::PadGrid pairs = parse_scene(replaced(two, "{ angle_deg", "{ " + grid), "scene.toml")
                                    .squeal->pads[0]
                                    .grid.value();
  EXPECT_EQ(pairs.rings, std::vector<std::string>{"inner"});
  EXPECT_EQ(pairs.opposite_rings, std::vector<std::string>{"track"});
}

TEST(SceneError, NamesWhatIsWrongWithContactPlanes)
{
  const auto with = [](const std::string& old_part, const std::string& new_part) {
    return error_of(replaced(disc_with_two_rings(), old_part, new_part));
  };
  const std::string ring = "ring = \"track\"";
  EXPECT_NE(with(ring, "ring = { inboard = \"inner\" }").find("outboard"), std::string::npos);
  EXPECT_NE(with(ring, "ring = { inboard = \"inner\", outboard = \"inner\" }")
                .find("must be another ring than inboard"),
            std::string::npos);
  EXPECT_NE(with(ring, "ring = { inboard = \"inner\", outboard = \"outer\" }").find("outer"),
            std::string::npos);
  EXPECT_NE(with("thickness = 0.03", "contact_planes = [0.01, -0.01]").find("z of the lower plane"),
            std::string::npos);
  EXPECT_NE(with("thickness = 0.03", "thickness = 0.03\ncontact_planes = [-0.01, 0.01]")
                .find("contact_planes"),
            std::string::npos);
  EXPECT_NE(with("thickness = 0.03", "thickness = 0.03\nslopes_from = [\"outer\"]").find("outer"),
            std::string::npos);
}

TEST(SceneError, NamesWhatAnIntegratorACriticalValueOrASoundLacks)
{
  const auto with = [](const std::string& lines) { return error_of(disc_scene + lines + "\n"); };
  EXPECT_EQ(error_of(replaced(disc_scene, "7e-8 }", "7e-8, integrator = \"euler\" }")),
            "scene.toml:41: squeal.transient.integrator = \"euler\": must be one of \"auto\", "
            "\"splitting\", \"exponential\", \"dormand-prince\", \"generalised-alpha\"");
  EXPECT_EQ(with("wav = { rate_Hz = 100 }"),
            "scene.toml:43: squeal.wav.rate_Hz = 100: must be >= 8000 and <= 192000 (Hz)");
  EXPECT_EQ(
      with("critical = [{ parameter = \"preload\", from = 2.0, to = 1.0, speed_rad_s = 19.0 }]"),
      "scene.toml:43: squeal.critical.to = 1: must be > 2 (from)");
  EXPECT_EQ(error_of(replaced(disc_scene, "\"growth\", \"transient\"]", "\"critical-values\"]")),
            "scene.toml:40: squeal.analyses = [ 'eigenvalues', 'critical-values' ]: "
            "\"critical-values\" needs the key critical");
}

TEST(SceneError, NamesPlaceAndRangeOfANumber)
{
  expect_messages({
      {"thickness = 0.02", "thickness = -0.02",
       "scene.toml:17: section.thickness = -0.02: must be > 0 (m)"},
      {"poisson = 0.3", "poisson = 0.5",
       "scene.toml:11: material.iron.poisson = 0.5: must be > -1 and < 0.5"},
      {"density = 6300.0", "density = nan",
       "scene.toml:12: material.iron.density = nan: must be >= 0 (kg/m^3)"},
      {"young = 9e10", "young = 0", "scene.toml:10: material.iron.young = 0: must be > 0 (Pa)"},
      {"outer_radius = 0.162", "outer_radius = 0.02",
       "scene.toml:5: mesh.outer_radius = 0.02: must be > 0.025 (m, the inner radius)"},
      {"radius = 0.13", "radius = 0.2",
       "scene.toml:8: mesh.rings.radius = 0.2: must be > 0.025 and < 0.162 "
       "(m, between the edges of the annulus)"},
      {"nodes = 60", "nodes = 2", "scene.toml:8: mesh.rings.nodes = 2: must be >= 3 and <= 100000"},
      {"friction = 0.6", "friction = -0.1", "scene.toml:37: squeal.friction = -0.1: must be >= 0"},
      {"from_rad_s = 3.0", "from_rad_s = 0.0",
       "scene.toml:36: squeal.speeds.from_rad_s = 0: must be > 0 (rad/s)"},
      {"analyses = [",
       "map = { parameter = \"friction\", from = 0.1, to = 1.0, count = 1000000 "
       "}\nanalyses = [",
       "scene.toml:40: squeal.map.count = 1000000: must be >= 1 and <= 166666 (10 million points "
       "with the speeds)"},
      {"count = 60", "count = 0",
       "scene.toml:36: squeal.speeds.count = 0: must be >= 2 and <= 1000000"},
      {"angle_deg = 90.0", "angle_deg = inf",
       "scene.toml:39: squeal.pads.angle_deg = inf: must be finite (degrees)"},
      {"[12.0, 13.0]", "[12.0, -1.0]",
       "scene.toml:42: squeal.growth.speeds_rad_s[2] = -1: must be > 0 (rad/s)"},
      {"7e-8 }", "7e-8, steps_per_period = 5 }",
       "scene.toml:41: squeal.transient.steps_per_period = 5: must be >= 8"},
      {"7e-8 }", "7e-8, growth_error_1_s = 0.0 }",
       "scene.toml:41: squeal.transient.growth_error_1_s = 0: must be > 0 (1/s)"},
      {"modes = 100", "modes = 3000000000",
       "scene.toml:26: reduce.modes = 3000000000: is too large"},
  });
}

const std::string rigid_disc = R"(name = "rigid"
[squeal]
model = "rigid disc"
rigid_disc = { diametral_inertia = 0.16, axial_inertia = 0.32, stiffness = 1.88e7, damping = 0.1, pad_radius = 0.13 }
thickness = 0.02
friction = { kinetic = 0.4, static = 0.6, decay_speed = 0.5 }
pads = [{ stiffness = 6e6, cubic_stiffness = 1e13, damping = 5.0, preload = 3000.0 }]
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 20 }
analyses = ["eigenvalues", "growth"]
growth = { speeds_rad_s = [12.0], duration_s = 3.0 }
)";

const std::string oscillator = R"([squeal]
model = "oscillator"
oscillator = { mass = 1.0, stiffness_along = 1.2e7, stiffness_normal = 4e6, stiffness_coupling = 1e6, damping_along = 5.0, damping_normal = 6.0, contact_stiffness = 7e6, preload = 500.0, radius = 0.13 }
friction = 0.3
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 20 }
analyses = ["critical-speed"]
)";

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
  EXPECT_EQ(scene.squeal_model->study.growth->duration, 3.0);
}

TEST(Scene, HasTheAnalysesOfABodyForAFlexibleDiscAlone)
{
  for (const squeal::Analysis& analysis : squeal::analyses) {
    const std::string asked = "analyses = [\"" + std::string(analysis.name) + "\"]";
    const std::string text = replaced(oscillator, "analyses = [\"critical-speed\"]", asked);
    if (analysis.needs_body) {
      EXPECT_NE(error_of(text).find("must be one of \"eigenvalues\", "), std::string::npos);
      EXPECT_EQ(error_of(text).find("\"spectrum\", "), std::string::npos);
    } else {
      EXPECT_EQ(error_of(text).find("must be one of"), std::string::npos) << analysis.name;
    }
  }
}

TEST(Scene, ReadsAnOscillator)
{
  const Scene scene = parse_scene(oscillator, "scene.toml");
  const auto& study = std::get<squeal::Oscillator>(scene.squeal_model->model);
  EXPECT_EQ(study.k_xy, 1e6);
  EXPECT_EQ(study.d_y, 6.0);
  EXPECT_EQ(study.friction.kinetic, 0.3);
}

TEST(Scene, ReadsTwoMassesWhoseNormalForceIsConstant)
{
  const std::string text = R"([squeal]
model = "two masses"
two_masses = { pad_mass = 0.5, pad_stiffness = 2e6, pad_damping = 4.0, disc_mass = 2.0, disc_stiffness = 8e6, disc_damping = 12.0, preload = 1000.0, radius = 0.13 }
friction = { kinetic = 0.3, static = 0.5, decay_speed = 0.5 }
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 20 }
analyses = ["critical-speed"]
)";
  const Scene scene = parse_scene(text, "scene.toml");
  const auto& masses = std::get<squeal::TwoMasses>(scene.squeal_model->model);
  EXPECT_EQ(masses.k_1, 2e6);
  EXPECT_EQ(masses.d_2, 12.0);
  EXPECT_DOUBLE_EQ(masses.friction.rise, 0.2);
  EXPECT_TRUE(error_of(replaced(text, "friction = {", "contact = \"bilateral\"\nfriction = {"))
                  .starts_with("scene.toml:4: squeal.contact is not a key here;"));
}

TEST(Scene, ReadsATiltingBlockWithFrictionThatRises)
{
  const Scene scene = parse_scene(R"([squeal]
model = "tilting block"
tilting_block = { mass = 1.0, inertia = 4e-4, stiffness_along = 1.2e7, stiffness_normal = 4e6, stiffness_tilting = 1800.0, damping_along = 5.0, damping_normal = 6.0, damping_tilting = 0.002, height = 0.02, foot_length = 0.04, foot_offset = -0.002, contact_stiffness = 7e6, preload = 500.0, radius = 0.13 }
friction = { kinetic = 0.5, static = 0.3, decay_speed = 0.5 }
contact = "signed"
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 20 }
analyses = ["critical-speed"]
)",
                                  "scene.toml");
  const auto& block = std::get<squeal::TiltingBlock>(scene.squeal_model->model);
  EXPECT_EQ(block.foot_offset, -0.002);
  EXPECT_EQ(block.d_phi, 0.002);
  EXPECT_DOUBLE_EQ(block.friction.rise, -0.2);
  EXPECT_EQ(block.law, squeal::ContactLaw::signed_force);
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
  const Scene scene = parse_scene(replaced(disc_scene, plain, good), "scene.toml");
  const squeal::PadPair& pad = scene.squeal->pads.at(0);
  EXPECT_DOUBLE_EQ(pad.grid->sector, std::numbers::pi * 2.0 / 9.0);
  EXPECT_EQ(pad.grid->points, 5);
  EXPECT_EQ(pad.body->axial->stiffness, 1e7);
  EXPECT_EQ(pad.body->about_radial->inertia, 2e-4);
  EXPECT_FALSE(pad.body->tangential);
  EXPECT_EQ(pad.caliper->axial.stiffness, 1e6);
  const auto error_after = [&](const std::string& from, const std::string& to) {
    return error_of(replaced(disc_scene, plain, replaced(good, from, to)));
  };
  EXPECT_EQ(error_after("grid = {", "radius = 0.02, grid = {"),
            "scene.toml:39: squeal.pads.radius = 0.02: is for a round face, and `grid` gives the "
            "points of "
            "another; leave out one of them");
  const std::string round = replaced(plain, "damping = 1.0", "damping = 1.0, radius = 0.02");
  EXPECT_EQ(parse_scene(replaced(disc_scene, plain, round), "scene.toml").squeal->pads.at(0).radius,
            0.02);
  EXPECT_EQ(error_after("points = 5", "points = 0"),
            "scene.toml:39: squeal.pads.grid.points = 0: must be >= 1 and <= 10000");
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
  EXPECT_TRUE(error_of(replaced(disc_scene, plain,
                                replaced(plain, "preload = 2000.0",
                                         "preload = 2000.0, body = { mass = 1.0 }")))
                  .ends_with("about_radial, about_tangential or about_axial"));
}

TEST(Scene, ReadsASpeedProgramThatBeginsWithTheSpeedOfTheTransient)
{
  const auto with = [](const std::string& points) {
    return replaced(disc_scene, "initial_pad_displacement = 7e-8",
                    "initial_pad_displacement = 7e-8, speed_program = " + points);
  };
  const Scene scene = parse_scene(
      with("[{ t_s = 1.0, speed_rad_s = 19.0 }, { t_s = 3.0, speed_rad_s = 0.0 }]"), "scene.toml");
  const auto& program = scene.squeal->study.transient->speed_program;
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

TEST(SceneError, LimitsTheNumberOfPads)
{
  const std::string pad = "{ angle_deg = 90.0, stiffness = 6e6, damping = 1.0, preload = 2000.0";
  std::string many = "pads = [";
  for (int i = 0; i < 1001; ++i) many += pad + " },";
  EXPECT_NE(error_of(replaced(disc_scene, "pads = [" + pad + " }]", many + "]"))
                .find("are 1001 pad pairs; there may be 1000"),
            std::string::npos);
  const std::string wide = pad + ", grid = { sector_deg = 60.0, points = 4000 } },";
  EXPECT_NE(error_of(replaced(disc_scene, "pads = [" + pad + " }]",
                              "pads = [" + wide + wide + wide + "]"))
                .find("have 12000 contact points in all; there may be 10000"),
            std::string::npos);
}

TEST(SceneError, TellsADecimalCommaInAFormula)
{
  const std::string error =
      error_of(replaced(disc_scene, "thickness = 0.02\n", "thickness = \"max(0,02, x)\"\n"));
  EXPECT_NE(error.find("section.thickness = \"max(0,02, x)\": "), std::string::npos) << error;
  EXPECT_NE(error.find("0.02"), std::string::npos) << error;
  EXPECT_EQ(error.find("scene.toml:"), 0u) << error;
}

TEST(SceneError, NamesWhatAModelWithoutABodyCannotTake)
{
  const auto error_after = [](const std::string& scene, const std::string& from,
                              const std::string& to) {
    return error_of(replaced(scene, from, to));
  };
  EXPECT_EQ(error_after(rigid_disc, "\"rigid disc\"", "\"rigid disk\""),
            "scene.toml:3: squeal.model = \"rigid disk\": must be one of \"flexible disc\", "
            "\"rigid disc\", \"oscillator\", \"two masses\", \"tilting block\", \"assembly\"");
  EXPECT_EQ(error_after(rigid_disc, "axial_inertia = 0.32", "axial_inertia = 0.0"),
            "scene.toml:4: squeal.rigid_disc.axial_inertia = 0: must be > 0 (kg m^2)");
  EXPECT_EQ(error_after(rigid_disc, "static = 0.6", "static = -0.3"),
            "scene.toml:6: squeal.friction.static = -0.3: must be >= 0");
  EXPECT_EQ(error_after(rigid_disc, ", decay_speed = 0.5", ""),
            "scene.toml:6: squeal.friction.decay_speed is missing: must be a number > 0 (m/s)");
  EXPECT_EQ(error_after(rigid_disc, "pad_radius = 0.13", "pad_radius = 0.13, drive = \"moment\""),
            "scene.toml:4: squeal.rigid_disc.drive = \"moment\": the constant moment 2 mu r_0 N_0 "
            "needs a constant friction coefficient");
  EXPECT_EQ(error_after(rigid_disc, "cubic_stiffness = 1e13", "cubic_stiffness = -1.0"),
            "scene.toml:7: squeal.pads.cubic_stiffness = -1: must be >= 0 (N/m^3)");
  EXPECT_TRUE(error_after(rigid_disc, "[{ stiffness", "[{ angle_deg = 3.0, stiffness")
                  .starts_with("scene.toml:7: squeal.pads.angle_deg is not a key here;"));
  EXPECT_TRUE(error_after(rigid_disc, "[\"eigenvalues\"", "[\"spectrum\"")
                  .starts_with("scene.toml:9: squeal.analyses[1] = \"spectrum\": must be one "));
  EXPECT_TRUE(error_after(rigid_disc, "[squeal]", "[mesh]\nfile = \"a.msh\"\n[squeal]")
                  .starts_with("scene.toml:2: mesh is not a key here;"));
  EXPECT_EQ(error_after(oscillator, "stiffness_coupling = 1e6", "stiffness_coupling = 1e8"),
            "scene.toml:3: squeal.oscillator.stiffness_coupling = 100000000: its square must be "
            "below stiffness_along times stiffness_normal, or the springs do not hold the mass");
}

TEST(SceneError, NamesPlaceAndTypeOfAValue)
{
  expect_messages({
      {"thickness = 0.02", "thickness = true",
       "scene.toml:17: section.thickness = true: must be a number > 0 (m)"},
      {"modes = 100", "modes = 1e2",
       "scene.toml:26: reduce.modes = 100: must be a whole number > 0"},
      {"title = \"Disc\"", "title = 3", "scene.toml:1: title = 3: must be a text in quotes"},
      {"nodes = [\"track\", \"hub\"]", "nodes = \"track\"",
       "scene.toml:23: interface.nodes = \"track\": must be a list of texts in quotes in [ ]"},
      {"keep = { modes = 40 }", "keep = 40", "scene.toml:29: body.keep = 40: must be a table"},
      {"modes = 100", "modes = 100\nsylvester = 1",
       "scene.toml:27: reduce.sylvester = 1: must be true or false"},
      {"use_modes = \"nodal-diameters 3\"", "use_modes = \"nodal-diameters three\"",
       "scene.toml:35: squeal.use_modes = \"nodal-diameters three\": must be \"all\", "
       "\"nodal-diameters N\" with N >= 1, or a list of mode numbers"},
  });
}

TEST(SceneError, NamesWhatIsMissing)
{
  expect_messages({
      {"young = 9e10\n", "",
       "scene.toml:9: material.iron.young is missing: must be a number > 0 (Pa)"},
      {"modes = 100\n", "",
       "scene.toml:24: reduce: give exactly one of modes, cutoff_Hz, tolerance"},
      {"generator = \"annulus\"\n", "", "scene.toml:2: mesh: give exactly one of generator, file"},
      {"growth = { speeds_rad_s = [12.0, 13.0], duration_s = 0.3 }\n", "",
       "scene.toml:40: squeal.analyses = [ 'eigenvalues', 'growth', 'transient' ]: "
       "\"growth\" needs the key growth"},
      {"analyses = [\"eigenvalues\", \"growth\", \"transient\"]\n"
       "transient = { speed_rad_s = 19.0, duration_s = 6.0, initial_pad_displacement = 7e-8 }\n",
       "analyses = [\"limit-cycle-direct\"]\n",
       "scene.toml:40: squeal.analyses = [ 'limit-cycle-direct' ]: \"limit-cycle-direct\" needs "
       "the "
       "key limit_cycle_direct, or else the speed in the key transient"},
  });
  EXPECT_EQ(error_of("title = \"nothing\"\n"), "scene.toml: mesh is missing: must be a table");
}

TEST(SceneError, NamesAnUnknownKeyAndTheNearestOnes)
{
  expect_messages({
      {"element_size", "elment_size",
       "scene.toml:7: mesh.elment_size is not a key here; did you mean element_size?"},
      {"element_order", "elementorder",
       "scene.toml:6: mesh.elementorder is not a key here; did you mean element_order? allowed: "
       "edge_row, element_order, element_size, extrude, file, generator, inner_radius, "
       "outer_radius, "
       "pattern, rings, sectors"},
      {"[body]", "[boddy]",
       "scene.toml:27: boddy is not a key here; did you mean body? allowed: accuracy, body, "
       "coupling, deviation, "
       "interface, load, mass, material, mesh, model, modes, name, reduce, response, section, "
       "sound, "
       "spring, squeal, static, support, title"},
      {"count = 60", "count = 60, colour = 3",
       "scene.toml:36: squeal.speeds.colour is not a key here; allowed: count, from_km_h, "
       "from_rad_s, from_rpm, to_km_h, to_rad_s, to_rpm, wheel_radius"},
      {"modes = 100", "mods = 100",
       "scene.toml:26: reduce.mods is not a key here; did you mean modes?"},
  });
}

TEST(SceneError, ListsAllUnknownKeysByLine)
{
  const std::string text = replaced(replaced(disc_scene, "keep =", "keeep ="), "title", "titel");
  EXPECT_TRUE(std::regex_match(error_of(text),
                               std::regex("scene.toml:1: titel .*\nscene.toml:29: body.keeep .*")));
}

TEST(SceneError, NamesAWordThatRefersToNothing)
{
  expect_messages({
      {"material = \"iron\"", "material = \"irn\"",
       "scene.toml:16: section.material = \"irn\": no such material in the scene; did you mean "
       "\"iron\"? there are: \"iron\""},
      {"\"track\", \"hub\"", "\"trak\", \"hub\"",
       "scene.toml:23: interface.nodes[1] = \"trak\": no such ring, edge or coupling in the scene; "
       "did you mean \"track\"? there are: \"track\", \"hub\", \"outer_edge\""},
      {"\"track\", \"hub\"", "\"track\", \"inner_edge\"",
       "scene.toml:23: interface.nodes[2] = \"inner_edge\": follows the reference node \"hub\"; "
       "name \"hub\" instead"},
      {"fixed = [\"hub\"]", "fixed = [\"wheel.z\"]",
       "scene.toml:28: body.fixed[1] = \"wheel.z\": no such interface node in the scene; there "
       "are: \"track\", \"hub\""},
      {"fixed = [\"hub\"]", "fixed = [\"hub.u\"]",
       "scene.toml:28: body.fixed[1] = \"hub.u\": the component must be one of \"x\", \"y\", "
       "\"z\", \"rx\", \"ry\", \"rz\""},
      {"ring = \"track\"", "ring = \"hub\"",
       "scene.toml:33: squeal.ring = \"hub\": no such ring in the scene; there are: \"track\""},
      {"group = \"disc\"", "group = \"dics\"",
       "scene.toml:14: section.group = \"dics\": no such group in the scene; did you mean "
       "\"disc\"? there are: \"disc\""},
      {"contact = \"bilateral\"", "contact = \"lateral\"",
       "scene.toml:38: squeal.contact = \"lateral\": must be one of \"unilateral\", "
       "\"bilateral\", \"signed\""},
  });
}

TEST(Scene, ReadsATolerancePromisedUpToAFrequency)
{
  const Scene scene = parse_scene(
      replaced(disc_scene, "modes = 100", "tolerance = 1e-3\nup_to_Hz = 8e3"), "scene.toml");
  ASSERT_TRUE(scene.reduce.tolerance.has_value());
  EXPECT_EQ(scene.reduce.tolerance->tolerance, 1e-3);
  EXPECT_EQ(scene.reduce.tolerance->up_to_Hz, 8e3);
}

TEST(SceneError, NamesWhatACouplingToANodeDoesNotTake)
{
  expect_messages({
      {"group = \"inner_edge\"", "group = \"inner_edge\"\nto = \"track\"",
       "scene.toml:20: coupling.name = \"hub\": is of a reference node; with `to` there is none"},
      {"group = \"inner_edge\"", "group = \"inner_edge\"\nat = [0.0, 1.0]",
       "scene.toml:22: coupling.at = [ 0.0, 1.0 ]: must be three numbers [x, y, z]"},
  });
}

TEST(SceneError, SaysWhatIsNotAvailableYet)
{
  expect_messages({
      {"type = \"rigid\"", "type = \"spring\"",
       "scene.toml:19: coupling.type = \"spring\": must be one of \"rigid\", \"averaging\", "
       "\"link\""},
      {"element_order = 3", "element_order = 5",
       "scene.toml:6: mesh.element_order = 5: must be >= 1 and <= 4"},
  });
}

/// A planar beam; the numbers of its lines stand in the tests below.
const std::string beam = R"(title = "Beam"
[mesh]
generator = "beam"
start = [0.0, 0.0, 0.0]
end = [3.0, 0.0, 4.0]
elements = 10
points = [{ name = "B", distance = 2.5 }]
[model]
dofs = ["ry", "z"]
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
group = "beam"
type = "beam"
material = "iron"
theory = "bernoulli-euler"
rotary_inertia = "none"
orientation = [1.0, 0.0, 0.0]
area = 1e-2
I_y = 1e-6
I_z = 2e-6
J = 3e-6
[interface]
nodes = ["start", "B"]
[reduce]
method = "craig-bampton"
modes = 10
resultants = ["beam"]
[body]
fixed = ["start.z"]
)";

TEST(Scene, SaysThatAToleranceDoesNotSeeTheStressOfBeams)
{
  const std::string stiffened =
      replaced(replaced(beam, "[\"ry\", \"z\"]", "[\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]"),
               "[body]", "stiffening = [\"spin-y\"]\n[body]");
  EXPECT_TRUE(parse_scene(stiffened, "beam.toml").notes.empty());
  const auto with_tolerance = [](const std::string& text) {
    return parse_scene(replaced(text, "modes = 10\n", "tolerance = 1e-3\nup_to_Hz = 50.0\n"),
                       "beam.toml");
  };
  const Scene scene = with_tolerance(stiffened);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].find("beam.toml: reduce.stiffening: the axial force of"), 0u);
  EXPECT_TRUE(with_tolerance(replaced(stiffened, "stiffening = [\"spin-y\"]\n", "")).notes.empty());
}

TEST(Scene, HoldsABeam)
{
  const Scene scene = parse_scene(beam, "beam.toml");
  ASSERT_TRUE(scene.mesh.beam);
  EXPECT_FALSE(scene.mesh.annulus);
  EXPECT_EQ(scene.mesh.beam->end, (std::array{3.0, 0.0, 4.0}));
  EXPECT_EQ(scene.mesh.beam->elements, 10);
  ASSERT_EQ(scene.mesh.beam->points.size(), 1u);
  EXPECT_EQ(scene.mesh.beam->points[0].distance, 2.5);
  EXPECT_EQ(scene.mesh.line_groups, std::vector<std::string>{"beam"});
  EXPECT_EQ(scene.components, (std::vector<int>{2, 4}));
  ASSERT_EQ(scene.beams.size(), 1u);
  EXPECT_EQ(scene.beams[0].theory, plate::BeamTheory::bernoulli_euler);
  EXPECT_FALSE(scene.beams[0].has_rotary_inertia);
  EXPECT_EQ(scene.beams[0].orientation, (std::array{1.0, 0.0, 0.0}));
  EXPECT_EQ(scene.beams[0].I_z, 2e-6);
  EXPECT_EQ(scene.resultants.groups, std::vector<std::string>{"beam"});
  EXPECT_TRUE(scene.sections.empty());
}

TEST(Scene, TakesAPointAtTheEndOfABeamInSpiteOfRounding)
{
  ASSERT_LT(0.3 - 0.1, 0.2);
  std::string text = replaced(beam, "start = [0.0, 0.0, 0.0]", "start = [0.0, 0.0, 0.1]");
  text = replaced(text, "end = [3.0, 0.0, 4.0]", "end = [0.0, 0.0, 0.3]");
  text = replaced(text, "distance = 2.5", "distance = 0.2");
  EXPECT_EQ(parse_scene(text, "scene.toml").mesh.beam->points[0].distance, 0.3 - 0.1);
}

TEST(Scene, TakesATimoshenkoBeamInSpaceUnlessTold)
{
  std::string text = replaced(beam, "theory = \"bernoulli-euler\"\nrotary_inertia = \"none\"\n",
                              "shear_factor_y = 0.85\n");
  text = replaced(text, "[model]\ndofs = [\"ry\", \"z\"]\n", "");
  const Scene scene = parse_scene(text, "beam.toml");
  EXPECT_EQ(scene.components.size(), 6u);
  EXPECT_EQ(scene.beams[0].theory, plate::BeamTheory::timoshenko);
  EXPECT_TRUE(scene.beams[0].has_rotary_inertia);
  EXPECT_EQ(scene.beams[0].shear_factor_y, 0.85);
  EXPECT_EQ(scene.beams[0].shear_factor_z, 5.0 / 6.0);
}

TEST(SceneError, NamesWhatABeamCannotBe)
{
  const auto expect = [](const std::string& good, const std::string& bad,
                         const std::string& message) {
    EXPECT_EQ(error_of(replaced(beam, good, bad)), message);
  };
  expect("end = [3.0, 0.0, 4.0]", "end = [3.0, 0.0]",
         "scene.toml:5: mesh.end = [ 3.0, 0.0 ]: must be three numbers [x, y, z]");
  expect("end = [3.0, 0.0, 4.0]", "end = [0.0, 0.0, 0.0]",
         "scene.toml:5: mesh.end = [ 0.0, 0.0, 0.0 ]: is the start of the beam too");
  expect("elements = 10", "elements = 0",
         "scene.toml:6: mesh.elements = 0: must be >= 1 and <= 1000000");
  expect("elements = 10\n", "", "scene.toml:2: mesh: give exactly one of elements, element_size");
  expect("distance = 2.5", "distance = 5.5",
         "scene.toml:7: mesh.points.distance = 5.5: must be >= 0 and <= 5 (m, along the beam)");
  expect("name = \"B\"", "name = \"end\"",
         "scene.toml:7: mesh.points.name = \"end\": is the name of another point or group of the "
         "mesh");
  expect("[\"ry\", \"z\"]", "[\"w\"]",
         "scene.toml:9: model.dofs[1] = \"w\": must be one of \"x\", \"y\", \"z\", \"rx\", "
         "\"ry\", \"rz\"");
  expect("type = \"beam\"", "type = \"shell\"",
         "scene.toml:16: section.type = \"shell\": the generator \"beam\" makes lines; use "
         "\"beam\"");
  expect("theory = \"bernoulli-euler\"", "theory = \"euler\"",
         "scene.toml:18: section.theory = \"euler\": must be one of \"timoshenko\", "
         "\"bernoulli-euler\"");
  expect("rotary_inertia = \"none\"", "rotary_inertia = \"no\"",
         "scene.toml:19: section.rotary_inertia = \"no\": must be one of \"full\", \"none\"");
  expect("rotary_inertia = \"none\"", "shear_factor_z = 0.8",
         "scene.toml:19: section.shear_factor_z = 0.8: a beam of Bernoulli and Euler is rigid in "
         "shear; take this key out");
  expect("orientation = [1.0, 0.0, 0.0]\n", "",
         "scene.toml:21: section.I_y = 1e-06: differs from the z axis, so that the section needs "
         "`orientation`, a vector [x, y, z] towards its z axis");
  expect("orientation = [1.0, 0.0, 0.0]", "orientation = [0.0, 0.0, 0.0]",
         "scene.toml:20: section.orientation = [ 0.0, 0.0, 0.0 ]: must not be zero; it points "
         "towards the z axis of the section");
  expect("I_y = 1e-6", "I_y = 0.0", "scene.toml:22: section.I_y = 0: must be > 0 (m^4)");
  expect("nodes = [\"start\", \"B\"]", "nodes = [\"A\"]",
         "scene.toml:26: interface.nodes[1] = \"A\": no such point or coupling in the scene; "
         "there are: \"start\", \"end\", \"B\"");
  expect("resultants = [\"beam\"]", "resultants = [\"rim\"]",
         "scene.toml:30: reduce.resultants[1] = \"rim\": no such group of elements in the scene; "
         "there are: \"beam\"");
  EXPECT_EQ(error_of(replaced(disc_scene, "type = \"shell\"", "type = \"beam\"")),
            "scene.toml:15: section.type = \"beam\": this generator makes surfaces; use \"shell\", "
            "or `extrude` in [mesh]");
}

/// The beam with a mass, a spring to the ground and a damper between its ends.
const std::string with_points = beam + R"([[mass]]
at = "end"
mass = 2.5
inertia = [1.0, 2.0, 2.5]
offset = [0.0, 0.0, 0.1]
[[spring]]
at = "B"
stiffness = { z = 1e6, ry = 20.0 }
[[spring]]
at = "start"
to = "end"
damping = { x = 35.0 }
)";

TEST(Scene, HoldsLumpedMassesSpringsAndDampers)
{
  const Scene scene = parse_scene(with_points, "beam.toml");
  ASSERT_EQ(scene.masses.size(), 1u);
  EXPECT_EQ(scene.masses[0].at, "end");
  EXPECT_EQ(scene.masses[0].mass, 2.5);
  EXPECT_EQ(scene.masses[0].inertia, (std::array{1.0, 2.0, 2.5, 0.0, 0.0, 0.0}));
  EXPECT_EQ(scene.masses[0].offset, (std::array{0.0, 0.0, 0.1}));
  ASSERT_EQ(scene.springs.size(), 2u);
  EXPECT_EQ(scene.springs[0].stiffness, (std::array{0.0, 0.0, 1e6, 0.0, 20.0, 0.0}));
  EXPECT_FALSE(scene.springs[0].to);
  EXPECT_EQ(scene.springs[1].to, "end");
  EXPECT_EQ(scene.springs[1].damping[0], 35.0);
}

TEST(Scene, KeepsTheDampersOfTheModelUnlessTheBodySaysOtherwise)
{
  using Type = mbs_export::Damping::Type;
  EXPECT_EQ(parse_scene(with_points, "beam.toml").body.damping.type, Type::matrix);
  EXPECT_EQ(parse_scene(beam, "beam.toml").body.damping.type, Type::none);
  const std::string said =
      replaced(with_points, "[body]\n", "[body]\ndamping = { type = \"none\" }\n");
  EXPECT_EQ(parse_scene(said, "beam.toml").body.damping.type, Type::none);
}

TEST(SceneError, NamesWhatAMassOrSpringCannotBe)
{
  const auto expect = [](const std::string& good, const std::string& bad,
                         const std::string& message) {
    EXPECT_EQ(error_of(replaced(with_points, good, bad)), message);
  };
  expect("at = \"end\"", "at = \"tip\"",
         "scene.toml:34: mass.at = \"tip\": no such group or coupling in the scene; there are: "
         "\"beam\", \"start\", \"end\", \"B\"");
  expect("mass = 2.5", "mass = 0.0", "scene.toml:35: mass.mass = 0: must be > 0 (kg)");
  expect("[1.0, 2.0, 2.5]", "[1.0, 2.0]",
         "scene.toml:36: mass.inertia = [ 1.0, 2.0 ]: must be three moments [xx, yy, zz] or six "
         "[xx, yy, zz, xy, xz, yz]");
  for (const char* inertia :
       {"[1.0, 2.0, 3.5]", "[-1.0, 2.0, 2.5]", "[1.0, 2.0, 2.5, 2.0, 0, 0]"}) {
    EXPECT_NE(error_of(replaced(with_points, "[1.0, 2.0, 2.5]", inertia))
                  .find("no rigid body has these moments"),
              std::string::npos)
        << inertia;
  }
  expect("stiffness = { z = 1e6, ry = 20.0 }", "",
         "scene.toml:39: spring[1].at = \"B\": the spring needs `stiffness` or `damping`, like { z "
         "= 1e6 }");
  expect("{ z = 1e6, ry = 20.0 }", "{ z = -1e6 }",
         "scene.toml:40: spring[1].stiffness.z = -1000000: must be >= 0 (N/m, N m/rad)");
  expect("{ z = 1e6, ry = 20.0 }", "{ w = 1e6 }",
         "scene.toml:40: spring[1].stiffness.w is not a key here; allowed: rx, ry, "
         "rz, x, y, z");
  expect("to = \"end\"", "to = \"start\"",
         "scene.toml:43: spring[2].to = \"start\": is the place where the spring begins");
}

TEST(SceneError, EndsKeysDeeperThanAStackInASentence)
{
  std::string key = "a";
  for (int i = 1; i < 40000; ++i) key += ".a";
  const std::string said = "a key has more than 16 parts; no key of a scene has so many";
  for (const std::string& text :
       {key + " = 1\n", "[" + key + "]\n", "x = { " + key + " = 1 }\n", "\"=\"." + key + " = 1\n"})
    EXPECT_EQ(error_of("\n" + text), "scene.toml:2: " + said);
  const std::string dots(40000, '.');
  EXPECT_EQ(error_of("title = \"" + dots + "\\\"" + dots + "\"  # " + dots + "\n").find(said),
            std::string::npos)
      << "texts and comments are no keys";
  EXPECT_EQ(changed_keys(key + " = 1\n", "", Step::squeal), std::vector<std::string>{})
      << "nor is the scene that a file names";
}

TEST(SceneError, NamesTheLineOfASyntaxError)
{
  EXPECT_TRUE(error_of(replaced(disc_scene, "[squeal]", "[squeal")).starts_with("scene.toml:32: "));
  EXPECT_TRUE(
      error_of(replaced(disc_scene, "young = 9e10", "young = ")).starts_with("scene.toml:10: "));
}

TEST(SceneError, KeepsFilesInTheirFolder)
{
  EXPECT_EQ(error_of(replaced(disc_scene, "title = \"Disc\"", "name = \"../disc\"")),
            "scene.toml:1: name = \"../disc\": names files: only letters, digits, _ and -");
}

TEST(SceneError, SaysWhatAFileIsThatIsNoScene)
{
  const auto folder = std::filesystem::temp_directory_path() / "chladni_no_scene";
  std::filesystem::create_directories(folder);
  const auto why = [&](const std::string& name) {
    const std::string file = (folder / name).string();
    std::ofstream(file) << (name == "empty.toml" ? "" : "1");
    try {
      read_scene(file);
    } catch (const Error& error) {
      return std::string(error.what()).substr(file.size() + 2);
    }
    return std::string("no error");
  };
  EXPECT_EQ(why("empty.toml"), "the scene file is empty");
  EXPECT_NE(why("disc.body.h5").find("is a result file"), std::string::npos);
  EXPECT_NE(why("disc.msh").find("`file` of [mesh]"), std::string::npos);
  for (const char* name : {"disc.MSH", "disc.med"})
    EXPECT_NE(why(name).find("`file` of [mesh]"), std::string::npos) << name;
  for (const char* name : {"hat.bdf", "hat.INP"})
    EXPECT_NE(why(name).find("chladni import"), std::string::npos) << name;
  EXPECT_NE(why("hat.vtk").find("gmsh FILE"), std::string::npos);
  EXPECT_NE(why("hat.vtu").find("meshio"), std::string::npos);
  EXPECT_THROW(read_scene(folder.string()), Error);
  std::filesystem::remove_all(folder);
}

TEST(SceneError, NamesAFileThatCannotBeRead)
{
  EXPECT_THROW(read_scene("/nowhere/scene.toml"), Error);
}

// A key that is taken out must be reported as missing; were two keys of one table spelled alike,
// the other one would be taken for a slip.
TEST(SceneError, NeverTakesOneKeyForAnother)
{
  std::istringstream lines(disc_scene);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[") || line.starts_with("type")) continue;
    const std::string message = error_of(replaced(disc_scene, line + "\n", ""));
    EXPECT_EQ(message.find("not a key"), std::string::npos) << line << ": " << message;
  }
}

}  // namespace
}  // namespace chladni::scene
