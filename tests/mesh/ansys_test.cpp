// Archives of Ansys: what is taken over, and the sentences for what is not.
#include <fmt/format.h>

#include "mesh/decks/ansys.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::expect_refused;
using testing::expect_words;
using testing::MeshFile;
using testing::Refusal;

Declarations declared_by_ansys(const std::string& text, double length_unit)
{
  return ansys_declarations(text, refuse_included, {.length = length_unit, .force = 1.0});
}

std::string nodes_block(const std::vector<std::array<double, 3>>& positions)
{
  std::string text = "NBLOCK,6,SOLID,        9,        9\n(3i9,6e21.13e3)\n";
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto& [x, y, z] = positions[i];
    text += fmt::format("{:9}{:9}{:9}{:21.13E}{:21.13E}{:21.13E}\n", i + 1, 0, 0, x, y, z);
  }
  return text + "N,R5.3,LOC,       -1,\n";
}

/// @param head  material, type, real constants, section
std::string element(const std::array<int, 4>& head, int number, const std::vector<int>& nodes)
{
  std::string text;
  for (const int value : head) text += fmt::format("{:9}", value);
  text += fmt::format("{:9}{:9}{:9}{:9}{:9}{:9}{:9}", 0, 0, 0, 0, nodes.size(), 0, number);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    text += (i == 8 ? "\n" : "") + fmt::format("{:9}", nodes[i]);
  return text + "\n";
}

std::string elements_block(const std::string& elements)
{
  return "EBLOCK,19,SOLID,        9,        9\n(19i9)\n" + elements + "       -1\n";
}

const std::string cube_block = nodes_block({{0, 0, 0},
                                            {2, 0, 0},
                                            {2, 2, 0},
                                            {0, 2, 0},
                                            {0, 0, 2},
                                            {2, 0, 2},
                                            {2, 2, 2},
                                            {0, 2, 2},
                                            {4, 0, 0}});
const std::string cube_of_8 = "/PREP7\n! a comment\nET,1,SOLID185\n" + cube_block +
                              elements_block(element({3, 1, 1, 1}, 5, {1, 2, 3, 4, 5, 6, 7, 8}));
const std::string ansys_steel =
    "MPTEMP,R5.0, 1, 1,  0.00000000    ,\nMPDATA,R5.0, 1,EX  ,       3, 1,  210000.000    ,\n"
    "MP,NUXY,3,0.3\nMP,DENS,3,7.85E-9\nMP,GXY,3,80769.2\n";

TEST(AnsysDeck, HasItsGroupsByMaterialsComponentsAndSupports)
{
  const Deck deck = ansys_deck(
      cube_of_8 + "CMBLOCK,LEFT    ,NODE,       2  ! a component\n(8i10)\n         1        -4\n" +
      "CMBLOCK,ALL_OF_IT,ELEM,       1\n(8i10)\n         5\n" +
      "D,        1,UX  ,  0.00000000    ,  0.00000000\nD,1,UZ,0\nD,LEFT,UX\nSF,LEFT,PRES,1\n");
  const Mesh mesh = mesh_of(deck, {.solid_groups = {"mat_3"}});
  EXPECT_EQ(mesh.n_nodes(), 8);
  EXPECT_EQ(mesh.blocks.at(0).shape, Shape::hexahedron);
  EXPECT_EQ(mesh.blocks[0].numbers, (std::vector<std::int64_t>{5}));
  EXPECT_EQ(find_group(mesh, "mat_3").dimension, 3);
  EXPECT_EQ(find_group(mesh, "LEFT").nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(find_group(mesh, "ALL_OF_IT").nodes.size(), 8U);
  EXPECT_EQ(find_group(mesh, "d_13").nodes, (std::vector<int>{0}));
  EXPECT_EQ(find_group(mesh, "d_1").nodes, (std::vector<int>{1, 2, 3}));
  expect_words(deck.notes.at(0), {"left out", "/PREP7", "SF"});
  const Mesh by_component = mesh_of(deck, {.solid_groups = {"ALL_OF_IT"}});
  EXPECT_EQ(by_component.groups[std::size_t(by_component.blocks.at(0).group.at(0))].name,
            "ALL_OF_IT");
}

TEST(AnsysDeck, TakesCollapsedHexahedraForWhatTheyAre)
{
  const auto mesh_of_element = [](const std::vector<int>& nodes) {
    return mesh_of(
        ansys_deck("ET,1,185\n" + cube_block + elements_block(element({3, 1, 1, 1}, 5, nodes))),
        {});
  };
  const Mesh wedge = mesh_of_element({1, 2, 3, 3, 5, 6, 7, 7});
  EXPECT_EQ(wedge.blocks.at(0).shape, Shape::wedge);
  EXPECT_EQ(wedge.n_nodes(), 15);
  const Mesh tetrahedron = mesh_of_element({1, 2, 3, 3, 5, 5, 5, 5});
  EXPECT_EQ(tetrahedron.blocks.at(0).shape, Shape::tetrahedron);
  EXPECT_EQ(tetrahedron.n_nodes(), 10);
}

class AnsysFile : public MeshFile {};

TEST_F(AnsysFile, OfShellsIsReadInItsUnitByAProcessOfItsOwn)
{
  const std::string shells =
      "ETBLOCK,        1,        1\n(2i9,19a9)\n        2      181        0        0\n       -1\n" +
      cube_block +
      elements_block(element({3, 2, 1, 4}, 5, {1, 2, 3, 4}) +
                     element({3, 2, 1, 4}, 6, {5, 6, 7, 7})) +
      ansys_steel +
      "SECTYPE,4,SHELL,,PLATE\nSECOFFSET,BOT\nSECBLOCK,1\n  0.5    ,        3,  0.0 ,  5\n";
  const std::string file = write("a.cdb", shells);
  const Mesh mesh = generate({.file = file, .length_unit = 1e-3});
  EXPECT_NEAR(area(mesh), 6e-6, 1e-18);
  const Declarations declared = declarations({.file = file}, {.length = 1e-3, .force = 1.0});
  ASSERT_EQ(declared.shells.size(), 1U);
  EXPECT_EQ(declared.shells[0].group, "sec_4");
  EXPECT_EQ(declared.shells[0].material, "mat_3");
  EXPECT_DOUBLE_EQ(declared.shells[0].thickness, 0.5e-3);
  EXPECT_DOUBLE_EQ(declared.shells[0].offset, 0.25e-3) << "the nodes are at the bottom";
}

TEST(AnsysDeclarations, AreInSI)
{
  const std::string points =
      "ET,2,21\nKEYOPT,2,3,2\nET,3,14\nKEYOPT,3,2,2\nR,7,0.5\nR,8,100.\n" +
      elements_block(element({1, 2, 7, 1}, 6, {7}) + element({1, 3, 8, 1}, 9, {7, 8}));
  const Declarations in_mm =
      declared_by_ansys(cube_of_8 + ansys_steel + points + "D,1,ALL\n", 1e-3);
  ASSERT_EQ(in_mm.materials.size(), 1U);
  EXPECT_EQ(in_mm.materials[0].name, "mat_3");
  EXPECT_NEAR(in_mm.materials[0].young, 2.1e11, 1.0);
  EXPECT_EQ(in_mm.materials[0].poisson, 0.3);
  EXPECT_NEAR(in_mm.materials[0].density, 7850.0, 1e-9);
  expect_words(declared_by_ansys(cube_of_8 + "MP,EX,3,1\nMP,NUXY,3,.3\n", 1e-3).notes.at(0),
               {"no density", "material.mat_3"});
  ASSERT_EQ(in_mm.solids.size(), 1U);
  EXPECT_EQ(in_mm.solids[0].group, "mat_3");
  EXPECT_EQ(in_mm.solids[0].material, "mat_3");
  ASSERT_EQ(in_mm.masses.size(), 1U);
  EXPECT_EQ(in_mm.masses[0].at, "mass21_6");
  EXPECT_DOUBLE_EQ(in_mm.masses[0].mass, 500.0) << "of t";
  ASSERT_EQ(in_mm.springs.size(), 1U);
  EXPECT_EQ(in_mm.springs[0].at, "combin14_9_1");
  EXPECT_EQ(in_mm.springs[0].to, "combin14_9_2");
  EXPECT_DOUBLE_EQ(in_mm.springs[0].stiffness[1], 1e5);
  ASSERT_EQ(in_mm.supports.size(), 1U);
  EXPECT_EQ(in_mm.supports[0].group, "d_123456");
}

class RefusedCommand : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedCommand, IsNamedWithItsLine)
{
  try {
    declared_by_ansys(GetParam().text, 1e-3);
    FAIL() << GetParam().text;
  } catch (const Error& error) {
    expect_refused(GetParam(), error.what());
  }
}

std::string with_element(const std::string& type, const std::vector<int>& nodes)
{
  return "ET,1," + type + "\n" + cube_block + elements_block(element({3, 1, 1, 1}, 5, nodes));
}

const std::vector<Refusal> refused_commands{
    {with_element("185", {1, 2, 3, 4, 5, 5, 5, 5}), {"line 16", "element 5", "pyramid"}},
    {with_element("185", {1, 2, 3, 4, 5, 6, 7, 1}), {"line 16", "element 5", "several corners"}},
    {with_element("174", {1, 2, 3, 4}), {"line 16", "type 174", "186"}},
    {with_element("185", {1, 2, 3}), {"line 16", "3 nodes"}},
    {cube_block + elements_block(element({3, 8, 1, 1}, 5, {1, 2, 3, 4, 5, 6, 7, 8})),
     {"line 15", "type 8, which no ET defines"}},
    {cube_of_8 + elements_block(element({3, 1, 1, 1}, 5, {1, 2, 3, 4, 5, 6, 7, 8})), {"twice"}},
    {cube_of_8, {"line 18", "material 3", "EX"}},
    {cube_of_8 + ansys_steel + "MP,EY,3,1.\n", {"material 3", "EY", "isotropic"}},
    {cube_of_8 + ansys_steel + "MPDATA,R5.0, 2,EX  ,       3, 1,  210000.0, 200000.0\n",
     {"EX of material 3", "temperature"}},
    {cube_of_8 + "CP,1,UX,1,2\n", {"line 20", "CP", "another one"}},
    {cube_of_8 + "*SET,TID,174\nET,7,TID\nEBLOCK,10,,,1\n(15i9)\n        6        7\n-1\n",
     {"line 22", "type 174", "contact"}},
    {cube_of_8 + "N,9,1.,2.\n", {"line 20", "NBLOCK"}},
    {cube_of_8 + "D,1,UX,0.1\n", {"line 20", "prescribes"}},
    {cube_of_8 + "D,1,TEMP\n", {"line 20", "TEMP"}},
    {cube_of_8 + "MP,EX,3,x\n", {"line 20", "is no number"}},
    {cube_of_8 + ansys_steel + "MP,GYZ,3,80900.\n", {"GYZ = 80900 is not 80769.2", "isotropic"}},
    {cube_of_8 + "D,99,UX\n", {"line 20", "no node 99"}},
    {cube_of_8 + "CMBLOCK,A,NODE,2\n(8i10)\n         4        -2\n", {"line 22", "no range"}},
    {"NBLOCK,6,SOLID\n(3i9,6e21.13e3)\n        1        0        x\n",
     {"line 3", "no whole number"}},
    {"NBLOCK,6,SOLID\n        1        0        0\n", {"line 1", "format"}}};

INSTANTIATE_TEST_SUITE_P(Ansys, RefusedCommand, ::testing::ValuesIn(refused_commands));

}  // namespace
}  // namespace chladni::mesh
