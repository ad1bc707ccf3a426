// Supports, loads and what `chladni static` and `chladni modes` read of a scene.
#include <gtest/gtest.h>

#include "scene/scene.hpp"
#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using test::error_of;
using test::replaced;

const std::string plate = R"([mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_size = 0.03
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
)";

TEST(SceneOfLoads, NeedsNoReduction)
{
  const Scene scene = parse_scene(plate + "[modes]\ncount = 7\n", "scene.toml");
  ASSERT_TRUE(scene.natural_modes);
  EXPECT_EQ(scene.natural_modes->count, 7);
  EXPECT_FALSE(scene.static_solution);
  EXPECT_TRUE(scene.interface_nodes.empty());
  EXPECT_NE(error_of(plate).find("interface is missing"), std::string::npos);
  EXPECT_TRUE(parse_scene(plate, "scene.toml", Purpose::fe_model).interface_nodes.empty());
  EXPECT_NE(error_of(plate + "[modes]\n[interface]\nnodes = [\"outer_edge\"]\n").find("reduce"),
            std::string::npos);
}

TEST(SceneOfLoads, ReadsEachSupport)
{
  const Scene scene = parse_scene(plate + R"([static]
[[support]]
group = "inner_edge"
type = "clamped"
[[support]]
group = "outer_edge"
type = "simply-supported"
[[support]]
group = "outer_edge"
type = "symmetry"
normal = "y"
[[support]]
group = "disc"
dofs = ["z", "rx"]
)",
                                  "scene.toml");
  ASSERT_EQ(scene.supports.size(), 4u);
  EXPECT_EQ(scene.supports[0].components, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(scene.supports[1].components, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(scene.supports[2].components, (std::vector<int>{1, 5, 3}));  // u_y, theta_z, theta_x
  EXPECT_EQ(scene.supports[3].components, (std::vector<int>{2, 3}));
  EXPECT_EQ(scene.supports[3].group, "disc");
}

TEST(SceneOfLoads, ReadsEachLoad)
{
  const Scene scene = parse_scene(plate + R"([static]
report = ["outer_edge"]
[[load]]
type = "force"
group = "outer_edge"
moment = [0.0, 0.0, 3.0]
[[load]]
type = "line"
group = "outer_edge"
line_force = [1.0, 2.0, 3.0]
[[load]]
type = "pressure"
group = "disc"
pressure = -5e3
[[load]]
type = "gravity"
acceleration = [0.0, 0.0, -9.81]
)",
                                  "scene.toml");
  ASSERT_EQ(scene.loads.size(), 4u);
  EXPECT_EQ(std::get<plate::NodalLoad>(scene.loads[0]).moment[2], 3.0);
  EXPECT_EQ(std::get<plate::NodalLoad>(scene.loads[0]).force[2], 0.0);
  EXPECT_EQ(std::get<plate::EdgeLoad>(scene.loads[1]).line_force[1], 2.0);
  EXPECT_EQ(std::get<plate::PressureLoad>(scene.loads[2]).pressure, -5e3);
  EXPECT_EQ(std::get<plate::GravityLoad>(scene.loads[3]).acceleration[2], -9.81);
  EXPECT_EQ(scene.static_solution->report, std::vector<std::string>{"outer_edge"});
}

TEST(SceneOfLoadsError, NamesWhatASupportCannotBe)
{
  const std::string support = plate + "[static]\n[[support]]\n";
  EXPECT_EQ(error_of(support + "group = \"inner_egde\"\ntype = \"clamped\"\n"),
            "scene.toml:17: support.group = \"inner_egde\": no such group, ring or coupling in the "
            "scene; did you mean \"inner_edge\"? there are: \"disc\", \"inner_edge\", "
            "\"outer_edge\"");
  EXPECT_EQ(error_of(support + "group = \"disc\"\ntype = \"hinged\"\n"),
            "scene.toml:18: support.type = \"hinged\": must be one of \"clamped\", "
            "\"simply-supported\", \"symmetry\"");
  EXPECT_EQ(error_of(support + "group = \"disc\"\ndofs = [\"x\", \"w\"]\n"),
            "scene.toml:18: support.dofs[2] = \"w\": must be one of \"x\", \"y\", \"z\", "
            "\"rx\", \"ry\", \"rz\"");
  EXPECT_EQ(error_of(support + "group = \"disc\"\ntype = \"clamped\"\ndofs = [\"x\"]\n"),
            "scene.toml:19: support.dofs = [ 'x' ]: give exactly one of type, dofs");
  EXPECT_EQ(error_of(support + "group = \"disc\"\ntype = \"symmetry\"\n"),
            "scene.toml:16: support.normal is missing: must be a text in quotes");
}

TEST(SceneOfLoadsError, NamesWhatALoadCannotBe)
{
  const std::string load = plate + "[static]\n[[load]]\n";
  EXPECT_EQ(error_of(load + "type = \"force\"\ngroup = \"disc\"\nforce = [1.0, 2.0]\n"),
            "scene.toml:19: load.force = [ 1.0, 2.0 ]: must be three numbers [x, y, z]");
  EXPECT_NE(error_of(load + "type = \"force\"\ngroup = \"disc\"\n").find("load.force is missing"),
            std::string::npos);
  EXPECT_EQ(error_of(load + "type = \"weight\"\n"),
            "scene.toml:17: load.type = \"weight\": must be one of \"force\", \"line\", "
            "\"pressure\", \"gravity\"");
  EXPECT_EQ(error_of(plate + "[static]\nreport = [\"rim\"]\n"),
            "scene.toml:16: static.report[1] = \"rim\": no such group, ring or coupling in the "
            "scene; there are: \"disc\", \"inner_edge\", \"outer_edge\"");
  EXPECT_EQ(error_of(plate + "[modes]\ncount = 0\n"),
            "scene.toml:16: modes.count = 0: must be >= 1");
}

TEST(SceneOfLoads, ReadsProfilesOfSections)
{
  const std::string table = "{ over = \"radius\", at = [0.03, 0.1], values = [0.02, 0.015] }";
  const Scene scene =
      parse_scene(replaced(plate, "0.02\n", table + "\noffset = -0.01\n") + "[static]\n", "s.toml");
  const plate::Profile& thickness = scene.sections[0].thickness;
  EXPECT_EQ(thickness.over, plate::Coordinate::radius);
  EXPECT_EQ(thickness.values, (std::vector<double>{0.02, 0.015}));
  EXPECT_EQ(scene.sections[0].offset, -0.01);
  const Scene by_formula =
      parse_scene(replaced(plate, "0.02\n", "\"0.02 * radius\"\n") + "[static]\n", "s.toml");
  EXPECT_EQ(by_formula.sections[0].thickness.formula, "0.02 * radius");
  const auto error = [&](const std::string& part, const std::string& wrong) {
    return error_of(replaced(plate, "0.02\n", replaced(table, part, wrong) + "\n") + "[static]\n");
  };
  EXPECT_EQ(error("0.1]", "0.03]"),
            "scene.toml:14: section.thickness.at[2] = 0.03: must be larger than the one before");
  EXPECT_EQ(
      error("[0.02, 0.015]", "[0.02]"),
      "scene.toml:14: section.thickness.values = [ 0.02 ]: must be as many as the numbers of at");
  EXPECT_EQ(error("0.015", "0.0"),
            "scene.toml:14: section.thickness.values[2] = 0: must be > 0 (m)");
  EXPECT_EQ(
      error("radius", "angle"),
      "scene.toml:14: section.thickness.over = \"angle\": must be one of \"x\", \"y\", \"z\", "
      "\"radius\"");
}

TEST(SceneOfLoads, ReadsLinksAndAverages)
{
  const std::string link =
      "[[coupling]]\ntype = \"link\"\ngroup = \"outer_edge\"\nto = \"inner_edge\"\n";
  const Scene scene =
      parse_scene(plate + "[static]\n" + link +
                      "[[coupling]]\ntype = \"averaging\"\nname = \"pad\"\ngroup = \"disc\"\n",
                  "s.toml");
  ASSERT_EQ(scene.couplings.size(), 2u);
  EXPECT_EQ(scene.couplings[0].kind, plate::CouplingKind::link);
  EXPECT_EQ(scene.couplings[0].to, "inner_edge");
  EXPECT_EQ(scene.couplings[1].kind, plate::CouplingKind::averaging);
  EXPECT_EQ(error_of(plate + "[static]\n" + replaced(link, "inner", "outer")),
            "scene.toml:19: coupling.to = \"outer_edge\": must be another group");
  EXPECT_EQ(error_of(plate + "[static]\n[model]\ndofs = [\"z\", \"rx\", \"ry\"]\n[[coupling]]\n" +
                     "type = \"averaging\"\nname = \"pad\"\ngroup = \"disc\"\n"),
            "scene.toml:19: coupling.type = \"averaging\": an average needs all six DOFs of each "
            "node; use \"rigid\", or take [model] out");
  EXPECT_NE(
      error_of(plate + "[static]\n" + replaced(link, "inner_edge", "rim")).find("no such group"),
      std::string::npos);
}

}  // namespace
}  // namespace chladni::scene
