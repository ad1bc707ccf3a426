// Universal files: what is taken over, and the sentences for what is not.
#include <fmt/format.h>

#include "mesh/exchange/unv.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::add_rectangle;
using testing::area;
using testing::error_of;
using testing::expect_refused;
using testing::expect_words;
using testing::MeshFile;
using testing::Refusal;

std::string dataset(const std::string& number, const std::string& lines)
{
  return "    -1\n  " + number + "\n" + lines + "    -1\n";
}

std::string node(int number, double x, double y)
{
  return fmt::format("{:10}         1         1        11\n  {:.16f}D+00  {:.16f}D+00  0.0D+00\n",
                     number, x, y);
}

const std::string six_nodes = dataset("2411", node(1, 0, 0) + node(2, 2, 0) + node(3, 2, 1) +
                                                  node(4, 0, 1) + node(5, 3, 0) + node(6, 3, 1));
const std::string quads =
    "7 94 1 1 7 4\n1 2 3 4\n"
    "8 94 2 1 7 4\n2 5 6 3\n";
const std::string lines = "9 21 3 1 7 2\n0 0 0\n1 4\n";
const std::string unv_plate = six_nodes + dataset("2412", quads + lines);

std::string groups(const std::string& members)
{
  return dataset("2467", members);
}

Mesh mesh_of_unv(const std::string& text, const MeshOptions& options = {})
{
  return mesh_of(unv_mesh(text, 1.0), options);
}

std::string error_in_unv(const std::string& text)
{
  try {
    mesh_of_unv(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Unv, NamesGroupsOfElementsAndNodes)
{
  const Mesh mesh = mesh_of_unv(
      unv_plate + groups("1 0 0 0 0 0 0 2\nthe plate\n8 7 0 0 8 8 0 0\n"
                         "2 0 0 0 0 0 0 3\nroot\n8 9 0 0 7 1 0 0\n7 4 0 0\n"
                         "3 0 0 0 0 0 0 1\n\n7 5 0 0\n4 0 0 0 0 0 0 1\nthe plate\n7 2 0 0\n"));
  EXPECT_EQ(find_group(mesh, "the plate").nodes, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(find_group(mesh, "the plate").dimension, 2);
  EXPECT_EQ(find_group(mesh, "the plate_nodes").nodes, (std::vector<int>{1}));
  EXPECT_EQ(find_group(mesh, "root").nodes, (std::vector<int>{0, 3}));
  EXPECT_EQ(find_group(mesh, "root").dimension, 1);
  EXPECT_EQ(find_group(mesh, "group_3").nodes, (std::vector<int>{4}));
  EXPECT_NEAR(area(mesh), 3.0, 1e-15);
  EXPECT_EQ(mesh.blocks.size(), 1u) << "lines are no elements unless a beam section names them";
}

TEST(Unv, MakesGroupsOfPhysicalPropertiesWhereThereAreNoOthers)
{
  const Mesh mesh = mesh_of_unv(unv_plate, {.line_groups = {"property_3_lines"}});
  EXPECT_EQ(find_group(mesh, "property_1").nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(find_group(mesh, "property_2").nodes, (std::vector<int>{1, 2, 4, 5}));
  EXPECT_EQ(mesh.blocks.at(1).shape, Shape::line);
}

/// Groups that overlap are usual; the one with a section says of what an element is made.
TEST(Unv, GivesAnElementOfSeveralGroupsThatWithASection)
{
  const std::string text = unv_plate + groups(
                                           "1 0 0 0 0 0 0 2\nall\n8 7 0 0 8 8 0 0\n"
                                           "2 0 0 0 0 0 0 1\nfar\n8 8 0 0\n"
                                           "3 0 0 0 0 0 0 1\nnear\n8 7 0 0\n");
  const auto groups_of = [&](const std::vector<std::string>& sections) {
    const Mesh mesh = mesh_of_unv(text, {.shell_groups = sections});
    std::vector<std::string> names;
    for (const int group : mesh.blocks.at(0).group) names.push_back(mesh.groups[group].name);
    EXPECT_EQ(find_group(mesh, "all").nodes.size(), 6u);
    EXPECT_EQ(find_group(mesh, "far").nodes, (std::vector<int>{1, 2, 4, 5}));
    return names;
  };
  EXPECT_EQ(groups_of({}), (std::vector<std::string>{"all", "all"}));
  EXPECT_EQ(groups_of({"far", "near"}), (std::vector<std::string>{"near", "far"}));
  EXPECT_EQ(groups_of({"far"}), (std::vector<std::string>{"all", "far"}));
  try {
    groups_of({"all", "far"});
    FAIL() << "two sections";
  } catch (const Error& error) {
    expect_words(error.what(), {"element 8", "\"all\"", "\"far\"", "section"});
  }
}

/// Around the edges, the node inside last; compared with places that tell the order.
TEST(Unv, NumbersNodesOfOrderTwoAroundTheEdges)
{
  std::string nodes;
  const std::vector<std::array<double, 2>> places{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2},
                                                  {1, 2}, {0, 2}, {0, 1}, {1, 1}};
  for (int i = 0; i < 9; ++i) nodes += node(i + 1, places[i][0], places[i][1]);
  const auto lattice_is_ordered = [&](const std::string& element) {
    const Mesh mesh = mesh_of_unv(dataset("2411", nodes) + dataset("2412", element));
    const ElementBlock& block = mesh.blocks.at(0);
    for (int k = 0; k < block.nodes_per_element; ++k) {
      const auto& x = mesh.positions[block.element_nodes(0)[k]];
      EXPECT_EQ(x[0], k % 3);
      EXPECT_EQ(x[1], k / 3);
    }
  };
  lattice_is_ordered("1 95 1 1 7 8\n1 2 3 4 5 6 7 8\n");
  lattice_is_ordered("1 45 1 1 7 9\n1 2 3 4 5 6 7 8\n9\n");
  const Mesh triangle =
      mesh_of_unv(dataset("2411", nodes) + dataset("2412", "1 92 1 1 7 6\n1 2 3 9 7 8\n"));
  const auto corner = [&](int k) {
    return triangle.positions[triangle.blocks.at(0).element_nodes(0)[k]];
  };
  EXPECT_EQ(corner(2), (std::array<double, 3>{2, 0, 0}));
  EXPECT_EQ(corner(4), (std::array<double, 3>{1, 1, 0}));
  EXPECT_EQ(corner(5), (std::array<double, 3>{0, 2, 0}));
}

TEST(Unv, LeavesOutWhatIsNoMesh)
{
  const Mesh mesh = mesh_of_unv(dataset("151", "a name\n\n") + unv_plate + dataset("2414", "1\n") +
                                dataset("164", "1  mm  2\n1.0D+03 1.0 1.0\n273.15\n"));
  std::string notes;
  for (const std::string& note : mesh.notes) notes += note + "\n";
  expect_words(notes, {"1 datasets of results", "dataset 164 says that 1 is 0.001 m"});
}

TEST(Unv, SaysNothingOfAFactorOfTheSameLengthUnit)
{
  // mesh_of_unv takes 1 as a metre.
  const Mesh mesh =
      mesh_of_unv(unv_plate + dataset("164", "1  m  2\n1.0000000001D+00 1.0 1.0\n273.15\n"));
  for (const std::string& note : mesh.notes) EXPECT_EQ(note.find("164"), std::string::npos) << note;
}

TEST(Unv, RefusesWhatIsWrongOrNotKnown)
{
  const std::vector<Refusal> refusals{
      {"1 2 3\n", {"\"1 2 3\"", "where a dataset begins"}},
      {six_nodes + dataset("2412", "1 117 1 1 7 4\n1 2 3 4\n"), {"descriptor 117", "a solid that"}},
      {six_nodes + dataset("2412", "1 136 1 1 7 2\n1 2\n"), {"descriptor 136"}},
      {six_nodes + dataset("2412", "1 94 1 1 7 3\n1 2 3\n"), {"3 nodes", "has 4"}},
      {six_nodes + dataset("2412", "1 94 1 1 7 99\n"), {"has 99 nodes"}},
      {six_nodes + dataset("2412", "1 94 1 1 7 4\n1 2 3\n"), {"dataset 2412", "ends where"}},
      {six_nodes + dataset("2412", "1 94 1 1 7 4\n1 2 x 4\n"), {"\"x\"", "number of a node"}},
      {unv_plate + dataset("2412", "7 94 1 1 7 4\n1 2 3 4\n"), {"element 7 is there twice"}},
      {unv_plate + dataset("2411", node(1, 0, 0)), {"node 1 is there twice"}},
      {dataset("2411", "1 1 1 1\n0.0 1e999 0.0\n"), {"\"1e999\"", "coordinate"}},
      {dataset("2411", "0 1 1 1\n0.0 0.0 0.0\n"), {"0 is no number of a node"}},
      {unv_plate + dataset("781", ""), {"dataset 781", "older form"}},
      {unv_plate + dataset("999", ""), {"dataset 999", "not known"}},
      {unv_plate + groups("1 0 0 0 0 0 0 1\nA\n9 7 0 0\n"), {"type 9"}},
      {unv_plate + groups("1 0 0 0 0 0 0 2\nA\n8 7 0 0\n"), {"ends where"}},
      {unv_plate + dataset("164", "1 x 2\n0.0 1.0 1.0\n"), {"factor of lengths"}}};
  for (const Refusal& refusal : refusals) expect_refused(refusal, error_in_unv(refusal.text));
  expect_words(error_in_unv(unv_plate + "    -1\n  2467\n"), {"cut off", "2467"});
  expect_words(error_in_unv(unv_plate + groups("1 0 0 0 0 0 0 2\nA\n8 7 0 0 8 9 0 0\n"
                                               "2 0 0 0 0 0 0 1\nA_lines\n8 9 0 0\n")),
               {"\"A_lines\" is there twice"});
  expect_words(error_in_unv(six_nodes + dataset("2412", "1 94 1 1 7 4\n1 2 3 44\n")),
               {"element 1", "node 44"});
}

TEST(Unv, PassesOverWordsBetweenDatasets)
{
  const std::string words = "Workpiece\nwritten on 2026-11-29, by 2 people\n";
  EXPECT_NEAR(area(mesh_of_unv(words + unv_plate + words)), 3.0, 1e-15);
}

TEST(Unv, NamesLinesOfAGroupOfSurfacesByTheirKind)
{
  for (const std::string& both :
       {groups("1 0 0 0 0 0 0 2\nA\n8 7 0 0 8 9 0 0\n"),
        groups("1 0 0 0 0 0 0 1\nA\n8 7 0 0\n2 0 0 0 0 0 0 1\nA\n8 9 0 0\n")}) {
    const Mesh mesh =
        mesh_of_unv(unv_plate + both, {.line_groups = {"A_lines"}, .shell_groups = {"A"}});
    EXPECT_EQ(find_group(mesh, "A").nodes, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(find_group(mesh, "A_lines").nodes, (std::vector<int>{0, 3}));
    EXPECT_EQ(mesh.blocks.size(), 2U);
  }
  const Mesh united =
      mesh_of_unv(unv_plate + groups("1 0 0 0 0 0 0 1\nA\n8 7 0 0\n2 0 0 0 0 0 0 1\nA\n8 8 0 0\n"));
  EXPECT_EQ(find_group(united, "A").nodes.size(), 6U);
}

TEST(Unv, HasAnElementOfTwoNumbersOnce)
{
  const std::string twice = unv_plate + dataset("2412", "70 94 1 1 7 4\n2 3 4 1\n") +
                            groups(
                                "1 0 0 0 0 0 0 2\nA\n8 7 0 0 8 8 0 0\n"
                                "2 0 0 0 0 0 0 1\nB\n8 70 0 0\n");
  const Mesh mesh = mesh_of_unv(twice, {.shell_groups = {"B"}});
  EXPECT_NEAR(area(mesh), 3.0, 1e-15);
  EXPECT_EQ(mesh.groups[std::size_t(mesh.blocks.at(0).group.at(0))].name, "B") << "has a section";
  EXPECT_EQ(mesh.groups[std::size_t(mesh.blocks.at(0).group.at(1))].name, "A");
  std::string notes;
  for (const std::string& note : mesh.notes) notes += note + "\n";
  expect_words(notes, {"7 and 70"});
  try {
    mesh_of_unv(twice, {.shell_groups = {"A", "B"}});
    FAIL() << "two sections";
  } catch (const Error& error) {
    expect_words(error.what(), {"element 7", "\"A\"", "\"B\"", "section"});
  }
}

class UnvFile : public MeshFile {};

/// Gmsh's own reader of 4.8 crashes on the groups that it writes itself.
TEST_F(UnvFile, OfGmshHasTheGroupsThatItWasWrittenWith)
{
  const std::string file = save("a.unv", [] {
    add_rectangle(0, 4, "plate");
    std::vector<std::pair<int, int>> curves;
    gmsh::model::getEntities(curves, 1);
    gmsh::model::setPhysicalName(1, gmsh::model::addPhysicalGroup(1, {curves.at(3).second}),
                                 "root");
    gmsh::model::mesh::generate(2);
    gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 1);
    gmsh::model::mesh::setOrder(2);
    gmsh::option::setNumber("Mesh.SaveGroupsOfNodes", 1);
  });
  const Mesh mesh = generate({.file = file});
  EXPECT_NEAR(area(mesh), 1.0, 1e-12);
  EXPECT_EQ(find_group(mesh, "root").nodes.size(), 3u);
  EXPECT_EQ(find_group(mesh, "plate").nodes.size(), 9u * 3u);
}

TEST_F(UnvFile, IsScaledByItsUnit)
{
  const std::string file = write("a.unv", unv_plate);
  EXPECT_NEAR(area(generate({.file = file, .length_unit = 1e-3})), 3e-6, 1e-18);
}

}  // namespace
}  // namespace chladni::mesh
