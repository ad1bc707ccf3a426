// A MED file written by the MED library: a plate of 3 x 2 cells of 100 mm, the last column of
// triangles. Files that are wrong are in integration.exchange, which writes them by h5py.
#include <algorithm>
#include <filesystem>

#include "mesh/exchange/med.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::error_of;
using testing::expect_words;
using testing::MeshFile;

const std::string of_the_library = CHLADNI_SOURCE_DIR "/tests/data/three_by_two.med";

TEST(Med, HasTheElementsAndGroupsOfItsFamilies)
{
  const Mesh mesh = generate({.file = of_the_library, .length_unit = 1e-3});
  EXPECT_NEAR(area(mesh), 0.3 * 0.2, 1e-15);
  EXPECT_EQ(mesh.n_nodes(), 12);
  EXPECT_EQ(find_group(mesh, "plate").nodes.size(), 12u);
  EXPECT_EQ(find_group(mesh, "far column").nodes, (std::vector<int>{2, 3, 6, 7, 10, 11}));
  EXPECT_EQ(find_group(mesh, "far column").dimension, 2);
  EXPECT_EQ(find_group(mesh, "root").nodes, (std::vector<int>{0, 4, 8}));
  EXPECT_EQ(find_group(mesh, "root").dimension, 1);
  EXPECT_EQ(find_group(mesh, "corner").nodes, (std::vector<int>{3}));
  EXPECT_EQ(mesh.positions[3], (std::array<double, 3>{0.3, 0, 0}));
}

/// Families are parts without overlap, of which groups are made; a section may name either group.
TEST(Med, GivesAnElementOfSeveralGroupsThatWithASection)
{
  const Mesh mesh = generate({.file = of_the_library, .shell_groups = {"far column"}});
  int n_far = 0;
  for (const ElementBlock& block : mesh.blocks)
    for (const int group : block.group) n_far += mesh.groups[group].name == "far column" ? 1 : 0;
  EXPECT_EQ(n_far, 4);
}

TEST(Med, MakesBeamsOfTheLinesThatASectionNames)
{
  const Mesh mesh = generate({.file = of_the_library, .line_groups = {"root"}});
  const auto is_line = [](const ElementBlock& block) { return block.shape == Shape::line; };
  const auto lines = std::ranges::find_if(mesh.blocks, is_line);
  ASSERT_NE(lines, mesh.blocks.end());
  EXPECT_EQ(lines->n_elements(), 2);
}

class MedFile : public MeshFile {};

TEST_F(MedFile, ThatIsNoneIsRefused)
{
  expect_words(error_of({.file = write("a.med", "no HDF5")}), {"a.med", "no HDF5 file"});
  const std::string body = CHLADNI_SOURCE_DIR "/tests/data/version_1.body.h5";
  std::filesystem::copy_file(body, path("b.med"));
  expect_words(error_of({.file = path("b.med")}), {"b.med", "no MED file", "INFOS_GENERALES"});
}

}  // namespace
}  // namespace chladni::mesh
