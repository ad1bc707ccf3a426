#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "scene_texts.hpp"

namespace chladni::cli {
namespace {

using testing::disc;
using testing::error_of;
using testing::expect_messages;
using testing::replaced;

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

TEST(SceneError, NamesPlaceAndRangeOfANumber)
{
  expect_messages({
      {"thickness = 0.02", "thickness = -0.02",
       "scene.toml:17: section.thickness = -0.02: must be > 0 (m)"},
      {"poisson = 0.3", "poisson = 0.5",
       "scene.toml:11: material.iron.poisson = 0.5: must be > -1 and < 0.5"},
      {"density = 6300.0", "density = nan",
       "scene.toml:12: material.iron.density = nan: must be > 0 (kg/m^3)"},
      {"young = 9e10", "young = 0", "scene.toml:10: material.iron.young = 0: must be > 0 (Pa)"},
      {"outer_radius = 0.162", "outer_radius = 0.02",
       "scene.toml:5: mesh.outer_radius = 0.02: must be > 0.025 (m, the inner radius)"},
      {"radius = 0.13", "radius = 0.2",
       "scene.toml:8: mesh.rings.radius = 0.2: must be > 0.025 and < 0.162 "
       "(m, between the edges of the annulus)"},
      {"nodes = 60", "nodes = 2", "scene.toml:8: mesh.rings.nodes = 2: must be >= 3"},
      {"friction = 0.6", "friction = -0.1", "scene.toml:37: squeal.friction = -0.1: must be >= 0"},
      {"from_rad_s = 3.0", "from_rad_s = 0.0",
       "scene.toml:36: squeal.speeds.from_rad_s = 0: must be > 0 (rad/s)"},
      {"count = 60", "count = 0", "scene.toml:36: squeal.speeds.count = 0: must be >= 2"},
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

TEST(SceneError, NamesPlaceAndTypeOfAValue)
{
  expect_messages({
      {"density = 6300.0", "density = \"6300.0\"",
       "scene.toml:12: material.iron.density = \"6300.0\": must be a number > 0 (kg/m^3)"},
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
       "edge_row, element_order, element_size, file, generator, inner_radius, outer_radius, "
       "pattern, rings"},
      {"[body]", "[boddy]",
       "scene.toml:27: boddy is not a key here; did you mean body? allowed: body, coupling, "
       "interface, load, mass, material, mesh, model, modes, name, reduce, section, spring, "
       "squeal, static, support, title"},
      {"count = 60", "count = 60, colour = 3",
       "scene.toml:36: squeal.speeds.colour is not a key here; allowed: count, from_rad_s, "
       "to_rad_s"},
      {"modes = 100", "mods = 100",
       "scene.toml:26: reduce.mods is not a key here; did you mean modes?"},
  });
}

TEST(SceneError, ListsAllUnknownKeysByLine)
{
  const std::string text = replaced(replaced(disc, "keep =", "keeep ="), "title", "titel");
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

TEST(SceneError, NamesTheLineOfASyntaxError)
{
  EXPECT_TRUE(error_of(replaced(disc, "[squeal]", "[squeal")).starts_with("scene.toml:32: "));
  EXPECT_TRUE(error_of(replaced(disc, "young = 9e10", "young = ")).starts_with("scene.toml:10: "));
}

TEST(SceneError, KeepsFilesInTheirFolder)
{
  EXPECT_EQ(error_of(replaced(disc, "title = \"Disc\"", "name = \"../disc\"")),
            "scene.toml:1: name = \"../disc\": names files: only letters, digits, _ and -");
}

TEST(SceneError, NamesAFileThatCannotBeRead)
{
  EXPECT_THROW(read_scene("/nowhere/scene.toml"), Error);
}

// A key that is taken out must be reported as missing; were two keys of one table spelled alike,
// the other one would be taken for a slip.
TEST(SceneError, NeverTakesOneKeyForAnother)
{
  std::istringstream lines(disc);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[") || line.starts_with("type")) continue;
    const std::string message = error_of(replaced(disc, line + "\n", ""));
    EXPECT_EQ(message.find("not a key"), std::string::npos) << line << ": " << message;
  }
}

}  // namespace
}  // namespace chladni::cli
