// Bulk data of Nastran: what is taken over, and the sentences for what is not.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "mesh/decks/nastran.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::error_of;
using testing::expect_refused;
using testing::expect_words;
using testing::MeshFile;
using testing::Refusal;

Deck deck_of_nastran(const std::string& text)
{
  return nastran_deck(nastran_cards(text));
}

Declarations declared_by_nastran(const std::string& text, double length_unit,
                                 double force_unit = 1.0)
{
  const std::vector<Card> cards = nastran_cards(text);
  return nastran_declarations(cards, nastran_deck(cards),
                              {.length = length_unit, .force = force_unit});
}

std::string error_in_nastran(const std::string& text)
{
  try {
    declared_by_nastran(text, 1e-3);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const std::string four_grid_points =
    "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,1.,0.\nGRID,4,,0.,1.,0.\n";
const std::string nastran_square = four_grid_points + "CQUAD4,1,7,1,2,3,4\n";
const std::string nastran_steel = "MAT1,9,2.1E5,,.3,7.85-9\n";
const std::string nastran_plate = nastran_square + nastran_steel + "PSHELL,7,9,2.,9,,9\n";

TEST(NastranCards, HaveSmallLargeAndFreeFields)
{
  std::vector<Card> cards = nastran_cards(
      "SOL 103\nCEND\nBEGIN BULK\n$ a comment\n"
      "GRID    1       3       1.5+3   -2.5-1  7.D1            $ behind it\n"
      "GRID*   2               3               .15             2.              *A\n"
      "*A      1.0E-3\n"
      "grid, 3,, 1., 2. ,3.\n"
      "SPC1    6       123456  1       2       3       4       5       6       +S1\n"
      "+S1     7       8\n"
      "GRID\t4\t\t1.\t2.\t3.\n"
      "ENDDATA\nnothing of this is read\n");
  std::erase_if(cards, [](const Card& card) { return card.name() == "CASE"; });
  ASSERT_EQ(cards.size(), 5U);
  EXPECT_EQ(cards[0].place(), "line 5");
  EXPECT_DOUBLE_EQ(cards[0].real(3, "x"), 1500.0);
  EXPECT_DOUBLE_EQ(cards[0].real(4, "y"), -0.25);
  EXPECT_DOUBLE_EQ(cards[0].real(5, "z"), 70.0);
  EXPECT_EQ(cards[1].name(), "GRID");
  EXPECT_EQ(cards[1].integer(2, "CP"), 3);
  EXPECT_DOUBLE_EQ(cards[1].real(5, "z"), 1e-3);
  EXPECT_DOUBLE_EQ(cards[2].real(4, "y"), 2.0);
  const std::vector<NumberRange> listed = cards[3].ranges(3, "node");
  ASSERT_EQ(listed.size(), 8U);
  EXPECT_EQ(listed[7].from, 8);
  EXPECT_DOUBLE_EQ(cards[4].real(3, "x"), 1.0);
}

TEST(NastranDeck, HasTheNodesOfARangeThatAreThere)
{
  const Deck deck =
      deck_of_nastran(four_grid_points + "SET1,5,4,1,THRU,3,1,THRU,2147483647\n,BY,3\n");
  EXPECT_EQ(deck.groups.at(0).nodes, (std::vector<std::int64_t>{4, 1, 2, 3, 1, 4}));
}

TEST(NastranDeck, PlacesNodesByCoordinateSystemsThatReferToEachOther)
{
  // 2 is turned by 90 degrees about z and stands at (10, 0, 0); 1 is cylindrical in it.
  const Deck deck = deck_of_nastran(
      "CORD2C,1,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
      "CORD2R,2,,10.,0.,0.,10.,0.,1.\n,10.,1.,0.\n"
      "GRID,1,1,3.,90.,5.\nGRID,2,2,3.,0.,0.\n");
  const auto at = [&](std::int64_t number, double x, double y, double z) {
    const auto& found = deck.nodes.at(number);
    EXPECT_NEAR(found[0], x, 1e-14);
    EXPECT_NEAR(found[1], y, 1e-14);
    EXPECT_NEAR(found[2], z, 1e-14);
  };
  at(1, 7.0, 0.0, 5.0);
  at(2, 10.0, 3.0, 0.0);
}

/// The grids of CORD1R stand in a system of CORD2R, and a second system is on the same card.
TEST(NastranDeck, PlacesNodesBySystemsOfGrids)
{
  const Deck deck = deck_of_nastran(
      "CORD1C,1,10,11,12,4,10,12,11\nCORD2R,2,,10.,0.,0.,10.,0.,1.\n,10.,1.,0.\n"
      "GRID,10,2,0.,0.,0.\nGRID,11,2,0.,0.,3.\nGRID,12,2,2.,0.,0.\n"
      "GRID,1,1,3.,90.,5.\nGRID,2,4,3.,90.,5.\n");
  const auto at = [&](std::int64_t number, double x, double y, double z) {
    const auto& found = deck.nodes.at(number);
    EXPECT_NEAR(found[0], x, 1e-14);
    EXPECT_NEAR(found[1], y, 1e-14);
    EXPECT_NEAR(found[2], z, 1e-14);
  };
  at(1, 7.0, 0.0, 5.0);   // x along (0, 1, 0), so that 90 degrees are along (-1, 0, 0)
  at(2, 13.0, 5.0, 0.0);  // z along (0, 1, 0) and x along (0, 0, 1): 90 degrees are along (1, 0, 0)
}

TEST(NastranDeck, KeepsTheAnalysisSetAndLeavesAnalysesOut)
{
  const Deck deck = deck_of_nastran(nastran_square +
                                    "ASET,1,123,2,123456\nASET1,123,3,THRU,4\nSPOINT,101,THRU,104\n"
                                    "QSET1,0,101,THRU,104\nPLOTEL,9,1,2\nTABDMP1,5\n");
  const auto aset = std::ranges::find(deck.groups, "aset", &DeckGroup::name);
  ASSERT_NE(aset, deck.groups.end());
  EXPECT_EQ(aset->nodes, (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(deck.notes.size(), 4U);
}

TEST(NastranDeck, NamesItsGroupsByPropertiesSetsAndConstraints)
{
  const Mesh mesh = mesh_of(
      deck_of_nastran(nastran_square +
                      "CTRIA3,2,8,1,2,3\nCBAR,3,5,1,2,0.,0.,1.\nSPC1,6,123,1,THRU,2\n"
                      "SPC,6,3,3,0.\nSET1,4,4\nRBE2,20,9,123456,2,3\nGRID,9,,0.,0.,0.,,12\n"),
      {.line_groups = {"pbar_5"}});
  EXPECT_EQ(find_group(mesh, "pshell_7").nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(find_group(mesh, "pshell_8").dimension, 2);
  EXPECT_EQ(find_group(mesh, "pbar_5").dimension, 1);
  EXPECT_EQ(find_group(mesh, "spc_6_123").nodes, (std::vector<int>{0, 1}));
  EXPECT_EQ(find_group(mesh, "spc_6_3").nodes, (std::vector<int>{2}));
  EXPECT_EQ(find_group(mesh, "set_4").nodes, (std::vector<int>{3}));
  EXPECT_EQ(find_group(mesh, "rbe2_20").nodes, (std::vector<int>{1, 2}));
  EXPECT_EQ(mesh.blocks.size(), 3U);
}

/// Column 73 is free, and a sorted deck has continuations apart from their lines.
TEST(NastranCards, AreContinuedByTheLineWithTheirMark)
{
  const std::vector<Card> cards = nastran_cards(
      "SPC1    6       123     1       2       3       4       5       6       XAB1\n"
      "SPC1    7       123     1       2       3       4       5       6       +CD1\n"
      "SPC1,8,123,1,2,3,4,5,6,EF1\n"
      "+CD1    8\n"
      "+AB1    7\n"
      "+EF1,9\n");
  ASSERT_EQ(cards.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(cards[i].ranges(3, "node").back().from, 7 + std::int64_t(i)) << i;
}

TEST(NastranCards, AreThoseOfIncludedFiles)
{
  const auto read = [](const std::string& file) -> std::string {
    if (file == "a/b.bdf") return "GRID,2,,1.\nINCLUDE 'c.bdf'\n";
    if (file == "a/c.bdf") return "GRID,3,,x\n";
    if (file == "loop.bdf") return "INCLUDE loop.bdf\n";
    throw Error("there is no " + file);
  };
  const std::vector<Card> cards = nastran_cards("GRID,1\nInclude 'a/b.bdf' $ more\nGRID,4\n", read);
  ASSERT_EQ(cards.size(), 4U);
  EXPECT_EQ(cards[2].place(), "line 1 of a/c.bdf");
  EXPECT_EQ(cards[3].place(), "line 3");
  const auto error = [&](const std::string& text) -> std::string {
    try {
      nastran_cards(text, read);
    } catch (const Error& refused) {
      return refused.what();
    }
    return "no error";
  };
  expect_words(error("GRID,1\nINCLUDE 'z.bdf'\n"), {"line 2", "no z.bdf"});
  expect_words(error("INCLUDE \"loop.bdf\"\n"), {"line 1 of loop.bdf", "includes this file"});
}

TEST(NastranDeck, HasTheDefaultsOfGrdset)
{
  const Deck deck = deck_of_nastran(
      "CORD2R,3,,5.,0.,0.,5.,0.,1.\n,6.,0.,0.\nGRDSET,,3,,,,,126\nGRID,1,,1.,0.,0.\n"
      "GRID,2,0,1.,0.,0.,,0\n");
  EXPECT_DOUBLE_EQ(deck.nodes.at(1)[0], 6.0);
  EXPECT_DOUBLE_EQ(deck.nodes.at(2)[0], 1.0);
  ASSERT_EQ(deck.groups.size(), 1U);
  EXPECT_EQ(deck.groups[0].name, "ps_126");
  EXPECT_EQ(deck.groups[0].nodes, (std::vector<std::int64_t>{1}));
}

TEST(NastranDeck, PlacesNodesBySphericalSystems)
{
  const Deck deck = deck_of_nastran(
      "CORD2S,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,5,2.,90.,90.\n"
      "GRID,2,5,2.,60.,0.\n");
  const auto &across = deck.nodes.at(1), &up = deck.nodes.at(2);
  EXPECT_NEAR(across[0], 0.0, 1e-15);
  EXPECT_NEAR(across[1], 2.0, 1e-15);
  EXPECT_NEAR(across[2], 0.0, 1e-15);
  EXPECT_NEAR(up[0], std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(up[2], 1.0, 1e-15) << "theta is measured from the z axis";
}

/// Two elements with the edge 2-3 in common; a card may leave out any of its middle nodes.
TEST(NastranDeck, HasMissingMiddleNodesOnStraightEdges)
{
  const Mesh mesh = mesh_of(
      deck_of_nastran(four_grid_points + "GRID,5,,4.,0.,0.\nGRID,6,,4.,1.,0.\nGRID,7,,2.,.5,.1\n"
                                         "CQUAD8,1,7,1,2,3,4,,\n,,\nCQUAD8,2,7,2,5,6,3,,\n,,7\n"
                                         "CTRIA6,3,7,1,2,5\nSET1,4,1,2\nSET1,5,1,4\n"),
      {});
  const ElementBlock& quads = mesh.blocks.at(0);
  const auto at = [&](int element, int place) {
    return mesh.positions[std::size_t(quads.element_nodes(element)[std::size_t(place)])];
  };
  EXPECT_EQ(at(0, 1), (std::array<double, 3>{1.0, 0.0, 0.0}));
  EXPECT_EQ(at(1, 3), (std::array<double, 3>{2.0, 0.5, 0.1})) << "that of the card";
  EXPECT_EQ(quads.element_nodes(0)[5], quads.element_nodes(1)[3]) << "that of the neighbour";
  EXPECT_EQ(find_group(mesh, "set_4").nodes.back(), quads.element_nodes(0)[1]);
  EXPECT_EQ(find_group(mesh, "set_5").nodes.size(), 3U) << "with the middle of 1 and 4";
  EXPECT_EQ(mesh.blocks.at(1).element_nodes(0)[1], quads.element_nodes(0)[1]) << "a new one, once";
  std::string notes;
  for (const std::string& note : mesh.notes) notes += note + "\n";
  expect_words(notes, {"middle nodes", "numbered from 8"});
}

TEST(NastranDeck, RefusesElementsOfTheSameNodesUnlessAsked)
{
  const Deck deck = deck_of_nastran(nastran_square + "CQUAD4,2,8,2,3,4,1\nCQUAD4,3,7,1,2,3,4\n");
  const auto n_elements = [&](Doubled doubled) {
    return mesh_of(deck, {.doubled_elements = doubled}).blocks.at(0).n_elements();
  };
  EXPECT_EQ(n_elements(Doubled::keep), 3);
  EXPECT_EQ(n_elements(Doubled::merge), 1);
  try {
    n_elements(Doubled::refuse);
    FAIL() << "doubled";
  } catch (const Error& error) {
    expect_words(error.what(), {"1 (line 5)", "2 (line 6)", "2 pairs", "doubled_elements"});
  }
}

/// Each kind of element has numbers of its own.
TEST(NastranDeck, LetsARigidElementHaveTheNumberOfAShell)
{
  const Deck deck = deck_of_nastran(nastran_square +
                                    "GRID,9,,1.,.5,0.\nRBE2,1,9,123456,1,2\nCONM2,1,9,,1.\n"
                                    "CELAS2,1,5.,1,3\n");
  EXPECT_EQ(deck.couplings.size(), 1U);
}

TEST(NastranDeck, HasItsFlatQuadrilateralsSplitAsThoseOfOtherFiles)
{
  const Mesh mesh = mesh_of(
      deck_of_nastran("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,.02,0.\nGRID,4,,1.,1.,0.\n"
                      "CQUAD4,1,7,1,2,3,4\n"),
      {});
  ASSERT_EQ(mesh.blocks.size(), 1U);
  EXPECT_EQ(mesh.blocks[0].shape, Shape::triangle);
  EXPECT_EQ(mesh.blocks[0].n_elements(), 2);
  ASSERT_EQ(mesh.notes.size(), 1U);
  EXPECT_NE(mesh.notes[0].find("1 quadrilaterals"), std::string::npos) << mesh.notes[0];
}

/// 2 x 1 by elements of each kind, in mm.
class NastranFile : public MeshFile {};

TEST_F(NastranFile, IsReadInItsUnitByAProcessOfItsOwn)
{
  const std::string curved =
      four_grid_points +
      "GRID,5,,1.,0.,0.\nGRID,6,,2.,.5,0.\nGRID,7,,1.,1.,0.\nGRID,8,,0.,.5,0.\nGRID,9,,1.,.5,0.\n";
  const std::vector<std::string> elements{
      "CQUAD4,1,7,1,2,3,4\n", "CTRIA3,1,7,1,2,3\nCTRIA3,2,7,1,3,4\n",
      "CQUAD8,1,7,1,2,3,4,5,6\n,7,8\n", "CTRIA6,1,7,1,2,3,5,6,9\nCTRIA6,2,7,1,3,4,9,7,8\n"};
  for (const std::string& of_kind : elements) {
    const std::string file = write("a.bdf", curved + of_kind);
    const Mesh mesh = generate({.file = file, .length_unit = 1e-3});
    EXPECT_NEAR(area(mesh), 2e-6, 1e-18) << of_kind;
  }
  const Declarations declared =
      declarations({.file = write("b.bdf", nastran_plate)}, {.length = 1e-3, .force = 1.0});
  EXPECT_EQ(declared.shells.size(), 1U);
  EXPECT_EQ(declared.materials.size(), 1U);
}

TEST_F(NastranFile, ErrorsNameFileLineAndCard)
{
  const std::string file = write("a.bdf", nastran_square + "CPYRAM,2,7,1,2,3,4,5\n");
  expect_words(error_of({.file = file}), {"a.bdf", "line 6", "CPYRAM 2", "hexahedra"});
  expect_words(error_of({.file = write("b.bdf", nastran_square + "CQUAD4,2,7,1,2,3,44\n")}),
               {"b.bdf", "element 2", "node 44"});
  expect_words(error_of({.file = path("absent.bdf")}), {"absent.bdf", "does not exist"});
  expect_words(error_of({.file = write("c.bdf", "")}), {"c.bdf", "neither solids nor shells"});
}

/// A corner of a cube, with one of six middle nodes.
const std::string nastran_tetrahedron =
    "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,0.,2.,0.\nGRID,4,,0.,0.,2.\nGRID,9,,0.,0.,1.1\n";

TEST(NastranSolids, MayLackMiddleNodesAndHaveAProperty)
{
  const std::string text = nastran_tetrahedron + "CTETRA,1,8,1,2,3,4,,\n,,9\nSPC1,4,123,1,2,3\n" +
                           "PSOLID,8,9,,TWO,,REDUCED\nMAT1,9,2.1+5,,.3,7.85-9\n";
  const Mesh mesh = mesh_of(deck_of_nastran(text), {.solid_groups = {"psolid_8"}});
  ASSERT_EQ(mesh.blocks.size(), 1U);
  EXPECT_EQ(mesh.blocks[0].nodes_per_element, 10);
  EXPECT_EQ(mesh.node_numbers[std::size_t(mesh.blocks[0].nodes[7])], 9) << "between 1 and 4";
  EXPECT_EQ(find_group(mesh, "spc_4_123").nodes.size(), 6U);
  expect_words(mesh.notes.at(0), {"5 middle nodes", "numbered from 10"});
  const Declarations declared = declared_by_nastran(text, 1e-3);
  ASSERT_EQ(declared.solids.size(), 1U);
  EXPECT_EQ(declared.solids[0].group, "psolid_8");
  EXPECT_EQ(declared.solids[0].material, "mat1_9");
  expect_words(declared.notes.at(0), {"PSOLID 8", "full integration"});
}

TEST(NastranSolids, FollowARigidElementOfThreeComponents)
{
  const std::string text = nastran_tetrahedron + "CTETRA,1,8,1,2,3,4\nPSOLID,8,9\n" +
                           "MAT1,9,2.1+5,,.3,7.85-9\nGRID,20,,5.,0.,0.\nRBE2,5,20,123,1,2,3\n";
  ASSERT_EQ(declared_by_nastran(text, 1e-3).couplings.size(), 1U);
  const Deck with_shells = deck_of_nastran(text + "CTRIA3,2,7,1,2,3\nPSHELL,7,9,1.,9,,9\n");
  EXPECT_TRUE(with_shells.couplings.empty()) << "the nodes of shells turn";
  EXPECT_EQ(with_shells.equations.size(), 9U);
}

TEST(NastranSolids, BesideShellsAreTakenByTheirSection)
{
  const std::string text = nastran_tetrahedron + "CTETRA,1,8,1,2,3,4\nCTRIA3,2,7,1,2,3\n";
  const Mesh solids = mesh_of(deck_of_nastran(text), {.solid_groups = {"psolid_8"}});
  ASSERT_EQ(solids.blocks.size(), 1U);
  EXPECT_EQ(solids.blocks[0].order, 2) << "four nodes are too few";
  EXPECT_EQ(find_group(solids, "pshell_7").nodes.size(), 6U) << "with the middles";
  const Mesh shells = mesh_of(deck_of_nastran(text), {.shell_groups = {"pshell_7"}});
  ASSERT_EQ(shells.blocks.size(), 1U);
  EXPECT_EQ(shells.blocks[0].shape, Shape::triangle);
}

TEST(NastranDeclarations, AreInSI)
{
  const Declarations in_mm =
      declared_by_nastran(nastran_plate +
                              "CBAR,30,40,1,2,0.,3.,0.\nPBAR,40,9,100.,833.,900.,1400.\n"
                              "CBEAM,31,41,1,2,0.,0.,1.\nPBEAM,41,9,100.,833.,900.,,1400.\n",
                          1e-3);
  ASSERT_EQ(in_mm.materials.size(), 1U);
  EXPECT_NEAR(in_mm.materials[0].young, 2.1e11, 1.0);
  EXPECT_NEAR(in_mm.materials[0].density, 7850.0, 1e-9);
  EXPECT_DOUBLE_EQ(in_mm.shells.at(0).thickness, 2e-3);
  const DeclaredBeam& bar = in_mm.beams.at(0);
  EXPECT_NEAR(bar.area, 1e-4, 1e-19);
  EXPECT_NEAR(bar.I_y, 833e-12, 1e-24) << "in the plane of the vector, along the scene's z";
  EXPECT_NEAR(bar.I_z, 900e-12, 1e-24);
  EXPECT_FALSE(bar.shear_factor_y);
  EXPECT_EQ(bar.orientation, (std::array<double, 3>{0.0, 1.0, 0.0}));
  EXPECT_EQ(in_mm.beams.at(1).shear_factor_z, 1.0);
  // Steel in inches, lbf and seconds.
  const Declarations in_inches = declared_by_nastran(
      nastran_square + "MAT1,9,3.0E7,,.3,7.33E-4\nPSHELL,7,9,.1,9,,9\n", 0.0254, 4.4482216);
  EXPECT_NEAR(in_inches.materials[0].young, 206.8e9, 0.1e9);
  EXPECT_NEAR(in_inches.materials[0].density, 7833.0, 2.0);
}

TEST(NastranDeclarations, HoldTheReferenceNodeOfAnRbe2ByItsCoupling)
{
  const Declarations declared = declared_by_nastran(
      nastran_plate + "GRID,9,,1.,.5,0.\nRBE2,20,9,123456,1,2\nSPC1,6,123456,9,3\n", 1e-3);
  ASSERT_EQ(declared.couplings.size(), 1U);
  EXPECT_EQ(declared.couplings[0].name, "node_9");
  EXPECT_EQ(declared.couplings[0].group, "rbe2_20");
  const std::array<double, 3> place = declared.couplings[0].at.value();
  EXPECT_NEAR(place[0], 1e-3, 1e-18) << "where the GRID stands, m";
  EXPECT_NEAR(place[1], 0.5e-3, 1e-18);
  ASSERT_EQ(declared.supports.size(), 2U);
  EXPECT_EQ(declared.supports[0].group, "node_9");
  EXPECT_EQ(declared.supports[1].group, "spc_6_123456");
}

/// What a rigid element hangs at: a node of the mesh, the reference of another, one that follows.
TEST(NastranDeclarations, LinkRigidElementsToNodesThatOthersHave)
{
  const Declarations declared = declared_by_nastran(
      nastran_plate +
          "GRID,9,,1.,.5,0.\nGRID,10,,5.,.5,0.\nGRID,11,,6.,.5,0.\nGRID,12,,0.,1.,0.\n"
          "RBE2,20,9,123456,1,10\nRBE2,21,9,123456,2\nRBAR,22,10,11,123456\nRBE2,23,3,123456,4\n"
          "CONM2,30,11,,2.-3\n",
      1e-3);
  ASSERT_EQ(declared.couplings.size(), 4U);
  EXPECT_EQ(declared.couplings[0].kind, CouplingOfDeck::rigid);
  const auto is_link = [&](std::size_t i, const std::string& group, const std::string& to) {
    EXPECT_EQ(declared.couplings[i].kind, CouplingOfDeck::rigid) << i;
    EXPECT_TRUE(declared.couplings[i].name.empty()) << i;
    EXPECT_EQ(declared.couplings[i].group, group);
    EXPECT_EQ(declared.couplings[i].to, to);
  };
  is_link(1, "rbe2_21", "node_9");
  is_link(2, "rbar_22", "leader_10");
  is_link(3, "rbe2_23", "leader_3");
  EXPECT_EQ(declared.masses.at(0).at, "conm2_30") << "11 follows, and stays in the mesh";
}

TEST(NastranDeclarations, HaveSixEquationsOfTwoTermsAsALink)
{
  std::string deck =
      "MPC = 4\nCEND\nBEGIN BULK\n" + nastran_plate + "GRID,12,,0.,1.,0.\nMPC,5,1,1,1.,2,1,1.\n";
  for (int c = 1; c <= 6; ++c) deck += fmt::format("MPC,4,12,{0},2.,4,{0},-2.\n", c);
  const Declarations declared = declared_by_nastran(deck, 1e-3);
  ASSERT_EQ(declared.couplings.size(), 1U);
  EXPECT_EQ(declared.couplings[0].group, "mpc_4_12");
  EXPECT_EQ(declared.couplings[0].to, "leader_4");
  EXPECT_NE(declared.notes.at(0).find("MPC of the set 5 are left out"), std::string::npos)
      << declared.notes[0];
}

TEST(NastranDeck, HasOtherEquationsRigidBodiesAndMeansAsEquations)
{
  const Deck deck = deck_of_nastran(
      nastran_plate + "MPC,4,1,1,1.,2,2,-2.,\n,,3,6,.5\nGRID,12,,0.,0.,5.\nRBE2,5,12,3,1\n" +
      "RBE3,6,,12,3,1.,123,1,2\n,2.,123,3\n");
  ASSERT_EQ(deck.equations.size(), 3U);
  const auto& [entry, terms] = deck.equations[2];
  EXPECT_EQ(entry, "line 8: MPC 4");
  ASSERT_EQ(terms.size(), 3U);
  EXPECT_EQ(terms[2].node, 3);
  EXPECT_EQ(terms[2].component, 5);
  EXPECT_EQ(terms[2].factor, 0.5);
  ASSERT_EQ(deck.equations[0].terms.size(), 2U) << "above each other: no arm for z";
  double sum = 0.0;
  for (const DeckEquation::Term& term : deck.equations[1].terms)
    if (term.component == 2) sum += term.factor;
  EXPECT_NEAR(sum, 0.0, 1e-15) << "a translation moves the mean as the nodes";
}

/// 30 degrees about z.
TEST(NastranDeck, HoldsComponentsInTheSystemOfANodeByAnEquation)
{
  const std::string text =
      "CORD2R,5,,0.,0.,0.,0.,0.,1.\n,.8660254,.5,0.\n" + nastran_steel +
      "GRID,1,,0.,0.,0.,5\nGRID,2,,2.,0.,0.\nGRID,3,,2.,1.,0.\nCTRIA3,1,7,1,2,3\n"
      "PSHELL,7,9,2.,9,,9\nSPC1,6,1,1,2\nSPC1,6,456,1\n";
  const Deck deck = deck_of_nastran(text);
  ASSERT_EQ(deck.equations.size(), 1U);
  ASSERT_EQ(deck.equations[0].terms.size(), 2U);
  EXPECT_NEAR(deck.equations[0].terms[0].factor, std::sqrt(0.75), 1e-7);
  EXPECT_NEAR(deck.equations[0].terms[1].factor, 0.5, 1e-7);
  const Declarations declared = declared_by_nastran(text, 1.0);
  ASSERT_EQ(declared.supports.size(), 2U);
  EXPECT_EQ(declared.supports[0].group, "spc_6_1");
  EXPECT_EQ(find_group(mesh_of(deck, {}), "spc_6_1").nodes, std::vector<int>{1});
  EXPECT_EQ(declared.supports[1].group, "spc_6_456") << "of all rotations axes do not matter";
}

TEST(NastranDeclarations, HoldWhatACardMovesAtZero)
{
  const Declarations declared = declared_by_nastran(nastran_plate + "SPC,6,1,3,.5\n", 1.0);
  ASSERT_EQ(declared.supports.size(), 1U);
  EXPECT_EQ(declared.supports[0].components, std::vector<int>{2});
  expect_words(declared.notes.at(0), {"SPC 6", "held at zero"});
}

TEST(NastranDeclarations, PartBarsOfAPropertyByTheirVectors)
{
  const std::string bars = nastran_plate +
                           "CBAR,3,5,1,2,0.,0.,1.\nCBAR,4,5,2,3,1.,0.,0.\n"
                           "CBAR,6,5,3,4,0.,0.,1.\n";
  const Declarations declared = declared_by_nastran(bars + "PBAR,5,9,1.,1.,2.,1.\n", 1.0);
  ASSERT_EQ(declared.beams.size(), 2U);
  EXPECT_EQ(declared.beams[0].group, "pbar_5");
  EXPECT_EQ(declared.beams[0].orientation, (std::array<double, 3>{0.0, 0.0, 1.0}));
  EXPECT_EQ(declared.beams[1].group, "pbar_5_2");
  EXPECT_EQ(declared.beams[1].orientation, (std::array<double, 3>{1.0, 0.0, 0.0}));
  EXPECT_EQ(declared_by_nastran(bars + "PBAR,5,9,1.,1.,1.,1.\n", 1.0).beams.size(), 1U);
}

TEST(NastranDeclarations, HoldTheSetsThatCaseControlChooses)
{
  const std::string sets =
      "BEGIN BULK\n" + nastran_plate + "SPC1,1,123,1\nSPC1,2,456,2\nSPC1,3,1,3\nSPCADD,77,1,2\n";
  const auto groups = [](const Declarations& declared) {
    std::vector<std::string> names;
    for (const DeclaredSupport& support : declared.supports) names.push_back(support.group);
    return names;
  };
  const Declarations one = declared_by_nastran("CEND\nspc = 3 $ the third\n" + sets, 1e-3);
  EXPECT_EQ(groups(one), (std::vector<std::string>{"spc_3_1"}));
  EXPECT_NE(one.notes.at(0).find("SPC of the set 1, 2 are left out"), std::string::npos)
      << one.notes[0];
  const Declarations joined = declared_by_nastran("SPC=77\nCEND\n" + sets, 1e-3);
  EXPECT_EQ(groups(joined), (std::vector<std::string>{"spc_1_123", "spc_2_456"}));
  const Declarations unchosen =
      declared_by_nastran("CEND\nBEGIN BULK\n" + nastran_plate + "SPC1,6,123,1\n", 1e-3);
  EXPECT_EQ(unchosen.supports.size(), 1U);
  EXPECT_NE(unchosen.notes.at(0).find("chooses no SPC"), std::string::npos);
}

TEST(NastranDeclarations, TellOfAMaterialWithoutADensity)
{
  const Declarations declared =
      declared_by_nastran(nastran_square + "MAT1,9,2.1E5,,.3\nPSHELL,7,9,2.,9,,9\n", 1e-3);
  EXPECT_EQ(declared.materials.at(0).density, 0.0);
  expect_words(declared.notes.at(0), {"line ", "no density", "material.mat1_9"});
}

TEST(NastranDeclarations, HaveMassesTimesTheirFactor)
{
  const std::string bulk = nastran_plate + "CONM2,3,1,,4.\n,2.,,3.,,,5.\n";
  const Declarations plain = declared_by_nastran(bulk, 1.0);
  for (const std::string& text :
       {bulk + "PARAM,WTMASS,.5\n", "SOL 103\nCEND\nPARAM,WTMASS,.5\nBEGIN BULK\n" + bulk}) {
    const Declarations half = declared_by_nastran(text, 1.0);
    EXPECT_DOUBLE_EQ(half.materials.at(0).density, 0.5 * plain.materials.at(0).density);
    EXPECT_DOUBLE_EQ(half.masses.at(0).mass, 2.0);
    EXPECT_DOUBLE_EQ(half.masses.at(0).inertia[1], 1.5);
  }
}

TEST(NastranDeclarations, TellWhereAMeanLeavesRotationsFree)
{
  const Declarations declared =
      declared_by_nastran(nastran_plate + "GRID,9,,0.,0.,1.\nRBE3,6,,9,123,1.,123,1,2,\n,3\n", 1.0);
  EXPECT_EQ(declared.couplings.at(0).kind, CouplingOfDeck::averaging);
  EXPECT_TRUE(std::ranges::any_of(declared.notes, [](const std::string& note) {
    return note.find("rotations of node 9") != std::string::npos;
  }));
}

TEST(NastranDeclarations, PassOverHeldNodesOfNoElement)
{
  const Declarations declared = declared_by_nastran(
      nastran_plate + "GRID,9,,1.,1.,0.\nSPC1,6,3,1,9\nGRID,10,,1.,1.,0.,,123\n", 1e-3);
  ASSERT_EQ(declared.supports.size(), 1U);
  EXPECT_EQ(declared.supports[0].group, "spc_6_3");
  EXPECT_NE(declared.notes.at(0).find("node 9, are passed over"), std::string::npos)
      << declared.notes[0];
}

TEST(NastranDeclarations, TakeAShearModulusOfTwoDigits)
{
  const Declarations declared = declared_by_nastran(nastran_square +
                                                        "MAT1,9,2.07E5,80.+3,.29,7.82-9\n"
                                                        "PSHELL,7,9,2.,9,,9\n",
                                                    1e-3);
  EXPECT_NEAR(declared.materials.at(0).poisson, 0.29, 1e-15);
  EXPECT_NE(declared.notes.at(0).find("two digits"), std::string::npos);
  // E / (2 (1 + NU)) = 80233, of which 79.+3 is not the first two digits.
  const std::string other = "MAT1,9,2.07E5,79.+3,.29,7.82-9\nPSHELL,7,9,2.,9,,9\n";
  EXPECT_NE(error_in_nastran(nastran_square + other).find("isotropic"), std::string::npos);
}

TEST(NastranDeclarations, HaveYoungsModulusOfTheOtherTwo)
{
  const Declarations declared =
      declared_by_nastran(nastran_square + "MAT1,9,,80.+3,.25,7.82-9\nPSHELL,7,9,2.,9,,9\n", 1e-3);
  EXPECT_NEAR(declared.materials.at(0).young, 2e11, 1e-3);
  EXPECT_NEAR(declared.materials.at(0).poisson, 0.25, 1e-15);
}

TEST(NastranDeclarations, HaveBarsRigidInShearWhereTheirFactorsAreZero)
{
  const std::string bar =
      nastran_plate + "CBAR,30,40,1,2,0.,3.,0.\nPBAR,40,9,100.,833.,900.,1400.\n";
  EXPECT_FALSE(declared_by_nastran(bar + ",\n,0.,0.\n", 1e-3).beams.at(0).shear_factor_y);
  const DeclaredBeam sheared = declared_by_nastran(bar + ",\n,.8,.9\n", 1e-3).beams.at(0);
  EXPECT_EQ(sheared.shear_factor_z, 0.8);
  EXPECT_EQ(sheared.shear_factor_y, 0.9);
  EXPECT_FALSE(declared_by_nastran(
                   nastran_plate + "CBEAM,31,41,1,2,0.,0.,1.\nPBEAM,41,9,100.,833.,900.,,1400.\n"
                                   ",\n,0.,0.\n",
                   1e-3)
                   .beams.at(0)
                   .shear_factor_y);
}

TEST(NastranDeclarations, HaveMassesAndSprings)
{
  const Declarations declared = declared_by_nastran(
      nastran_plate +
          "GRID,9,,1.,.5,0.\nRBE2,20,9,123456,1,2\n"
          "CONM2,30,9,,2.-3,1.,0.,5.\n,8.,1.,9.,2.,3.,10.\nCONM2,31,3,-1,1.-3,2.,1.,4.\n"
          "PELAS,40,50.,,,41,70.\nCELAS1,32,41,3,5\nCELAS2,33,100.,1,3,9,3\nCELAS2,34,5.,,,4,1\n",
      1e-3);
  ASSERT_EQ(declared.masses.size(), 2U);
  const DeclaredMass& hub = declared.masses[0];
  EXPECT_EQ(hub.at, "node_9");
  EXPECT_NEAR(hub.mass, 2.0, 1e-12) << "t";
  EXPECT_NEAR(hub.offset[2], 5e-3, 1e-15);
  const std::array<double, 6> expected{8e-3, 9e-3, 10e-3, -1e-3, -2e-3, -3e-3};  // of t mm^2
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(hub.inertia[i], expected[i], 1e-15) << i;
  EXPECT_EQ(declared.masses[1].at, "conm2_31");
  EXPECT_NEAR(declared.masses[1].offset[2], 4e-3, 1e-15) << "from where the centre is";
  EXPECT_NEAR(declared.masses[1].offset[0], 0.0, 1e-15);
  ASSERT_EQ(declared.springs.size(), 3U);
  EXPECT_EQ(declared.springs[0].at, "celas_32_1");
  EXPECT_NEAR(declared.springs[0].stiffness[4], 70e-3, 1e-15) << "N mm/rad";
  EXPECT_FALSE(declared.springs[0].to);
  EXPECT_EQ(declared.springs[1].at, "celas_33_1");
  EXPECT_EQ(declared.springs[1].to, "node_9");
  EXPECT_NEAR(declared.springs[1].stiffness[2], 1e5, 1e-9);
  EXPECT_EQ(declared.springs[2].at, "celas_34_2");
}

TEST(NastranDeclarations, HaveBarsByTheirShapes)
{
  const std::string bars =
      nastran_plate + "CBAR,3,5,1,2,0.,3.,0.\nCBAR,4,6,1,2,0.,0.,1.\nCBAR,6,8,2,3,0.,0.,1.\n";
  const Declarations declared = declared_by_nastran(
      bars + "PBARL,5,9,,BAR\n,2.,6.\nPBARL,6,9,,ROD\n,2.\nPBARL,8,9,,TUBE\n,3.,2.\n", 1e-3);
  ASSERT_EQ(declared.beams.size(), 3U);
  const DeclaredBeam &bar = declared.beams[0], &rod = declared.beams[1], &tube = declared.beams[2];
  EXPECT_NEAR(bar.area, 12e-6, 1e-18);
  EXPECT_NEAR(bar.I_y, 36e-12, 1e-24) << "6 mm high in the plane of the vector";
  EXPECT_NEAR(bar.I_z, 4e-12, 1e-24);
  EXPECT_NEAR(bar.shear_factor_y.value(), 5.0 / 6.0, 1e-15);
  EXPECT_NEAR(bar.shear_factor_z.value(), 5.0 / 6.0, 1e-15);
  EXPECT_NEAR(bar.J / 12.64e-12, 1.0, 2e-3) << "0.2633 a b^3 of a rectangle of 3 to 1";
  EXPECT_EQ(bar.orientation, (std::array<double, 3>{0.0, 1.0, 0.0}));
  EXPECT_NEAR(rod.J, 8.0 * std::numbers::pi * 1e-12, 1e-22);
  EXPECT_FALSE(rod.orientation);
  EXPECT_NEAR(tube.area, 5.0 * std::numbers::pi * 1e-6, 1e-17);
  EXPECT_NEAR(tube.I_y, 65.0 / 4.0 * std::numbers::pi * 1e-12, 1e-22);
}

class RefusedCard : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedCard, IsNamedWithItsLine)
{
  expect_refused(GetParam(), error_in_nastran(GetParam().text));
}

const std::vector<Refusal> refused_cards{
    {nastran_plate + "CGAP,5,100,1,2\n", {"line 8", "CGAP 5", "is a contact"}},
    {nastran_plate + "CONM2,5,1,3,.5\n", {"CONM2 5", "system CID"}},
    {nastran_plate + "CONM2,5,9,,.5\n", {"CONM2 5", "no node 9"}},
    {nastran_plate + "GRID,9,,0.,0.,0.\nCONM2,5,9,,.5\n", {"CONM2 5", "node 9", "no coupling"}},
    {nastran_plate + "CELAS2,5,100.,1\n", {"CELAS2 5", "no component"}},
    {nastran_plate + "CELAS2,5,100.,1,1,2,3\n", {"CELAS2 5", "two components"}},
    {nastran_plate + "CELAS2,5,-100.,1,1\n", {"CELAS2 5", "negative"}},
    {nastran_plate + "CELAS2,5,100.,1,1,,,.1\n", {"CELAS2 5", "GE"}},
    {nastran_plate + "CELAS2,5,100.\n", {"CELAS2 5", "at no node"}},
    {nastran_plate + "CELAS1,5,6,1,1\n", {"CELAS1 5", "no PELAS 6"}},
    {nastran_plate + "CBAR,3,5,1,2,0.,0.,1.\nPBARL,5,9,,I\n,1.,1.,1.,1.,1.,1.\n",
     {"PBARL 5", "ROD, TUBE and BAR"}},
    {nastran_plate + "CBAR,3,5,1,2,0.,0.,1.\nPBARL,5,9,,TUBE\n,1.,1.\n",
     {"PBARL 5", "inner radius"}},
    {nastran_plate + "CBAR,3,5,1,2,0.,0.,1.\nPBARL,5,9,,BAR\n,1.,1.,2.\n", {"PBARL 5", "NSM"}},
    {nastran_plate + "CTETRA,5,7,1,2,3\n", {"CTETRA 5", "field 7", "number of a node"}},
    {nastran_plate + "CTETRA,5,8,1,2,3,4\n", {"element 5 is of psolid_8", "no such property"}},
    {nastran_plate + "CTETRA,5,8,1,2,3,4\nPSOLID,8,9,,,,,PFLUID\n", {"PSOLID 8", "PFLUID"}},
    {nastran_plate + "INCLUDE 'more.bdf'\n", {"line 8", "more.bdf"}},
    {nastran_plate + "GRID,1,,0.,0.,0.\n", {"GRID 1", "twice"}},
    {nastran_plate + "GRID,5,3,0.,0.,0.\n", {"GRID 5", "no coordinate system 3"}},
    {nastran_plate + "GRID,5,,a.,0.,0.\n", {"GRID 5", "\"A.\" in field 4"}},
    {nastran_plate + "GRID,-5,,0.,0.,0.\n", {"\"-5\" in field 2"}},
    {nastran_plate + "CORD2R,3,4,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n",
     {"CORD2R 3", "no coordinate system 4"}},
    {nastran_plate + "CORD2R,3,3,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n", {"CORD2R 3", "refers to itself"}},
    {nastran_plate + "CORD2R,3,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\n", {"CORD2R 3", "on one line"}},
    {nastran_plate + "CQUAD4,1,7,1,2,3,4\n", {"CQUAD4 1", "another element"}},
    {nastran_plate + "CQUAD4,2,7,1,2,3,4,,.5\n", {"CQUAD4 2", "offset"}},
    {nastran_plate + "CQUAD4,2,7,1,2,3,4\n,,,2.\n", {"CQUAD4 2", "thickness of its own"}},
    {nastran_plate + "CQUAD8,2,7,1,2,3\n", {"CQUAD8 2", "field 7"}},
    {nastran_plate + "CQUAD8,2,7,1,2,3,4\n",
     {"line 8", "element 2", "between", "element 1 of order 1"}},
    {nastran_plate + "CBAR,2,5,1,2,0.,0.,1.\n,456\n", {"CBAR 2", "released"}},
    {nastran_plate + "SPC1,6,128,1\n", {"SPC1 6", "no components"}},
    {nastran_plate + "SPC1,6,3,1\nSPC1,7,3,2\n", {"SPC1 7", "second set"}},
    {nastran_plate + "SET1,6,9,THRU,5\n", {"SET1 6", "no range"}},
    {nastran_plate + "RBE2,6,9,123,1,2\n", {"RBE2 6", "no node 9"}},
    {nastran_plate + "RBE2,6,9,123456,1,2\n", {"RBE2 6", "no node 9"}},
    {nastran_plate + "RBE3,6,,4,123456,1.,123,1,2\n", {"RBE3 6", "node 4"}},
    {nastran_plate + "RBAR,6,1,2,123,456\n", {"RBAR 6", "not wholly rigid"}},
    {nastran_plate + "MPC,6,1,1,1.,9,1,-1.\n", {"MPC 6", "no GRID 9"}},
    {nastran_plate + "MPC,6,1,12,1.,2,1,-1.\n", {"MPC 6", "one component"}},
    {nastran_plate + "MPC,6\n", {"MPC 6", "no terms"}},
    {"SPC = 5\nCEND\nBEGIN BULK\n" + nastran_plate + "SPC1,6,3,1\n",
     {"line 1", "CASE SPC", "no SPC 5"}},
    {"CEND\nSPC = 5\nSPC = 6\nBEGIN BULK\n" + nastran_plate, {"line 3", "line 2 chooses SPC = 5"}},
    {nastran_plate + "CBAR,3,5,1,2,0.,0.,1.\nPBAR,5,9,1.,1.,2.,1.\n\n,\n,1.,0.\n",
     {"PBAR 5", "one of its two planes"}},
    {nastran_plate + "GRDSET,,,,,,,1\nGRDSET,,,,,,,2\n", {"GRDSET", "one already"}},
    {nastran_plate + "RBE3,6,,9,123456,1.,123,1,2\n,2.,123456,3\n", {"RBE3 6", "other components"}},
    {nastran_plate + "GRID,9,,0.,0.,1.\nRBE3,6,,9,123456,1.,123,1\n,2.,123,2\n",
     {"RBE3 6", "on one line"}},
    {nastran_plate + "PARAM,WTMASS,0.\n", {"PARAM WTMASS", "positive factor"}},
    {nastran_plate + "PARAM,WTMASS,2.\nPARAM,WTMASS,3.\n", {"line 9", "line 8 says another"}},
    {nastran_plate + "PCOMP,8,,,,,,,,\n,9,1.,0.\n", {"PCOMP 8", "laminate", "mesh.matrices"}},
    {nastran_plate + "MAT8,8,1.,1.,.3,1.\n", {"MAT8 8", "not isotropic"}},
    {nastran_plate + "CORD1R,3,1,2,9\n", {"CORD1R 3", "no GRID 9"}},
    {nastran_plate + "CORD1R,3,1,2,2\n", {"CORD1R 3", "on one line"}},
    {nastran_plate + "GRID,9,3,1.,0.,0.\nCORD1R,3,1,2,9\n", {"CORD1R 3", "refers to itself"}},
    {nastran_plate + "RBE3,6,,9,12,1.,123,1,2\n,3\n", {"RBE3 6", "no node 9"}},
    {nastran_square + nastran_steel + "PSHELL,7,9,2.\n", {"PSHELL 7", "MID2"}},
    {nastran_square + nastran_steel + "PSHELL,7,9,2.,9,.5,9\n", {"PSHELL 7", "12I/T**3"}},
    {nastran_square + nastran_steel + "PSHELL,7,9,2.,9,,9,,1.-9\n", {"PSHELL 7", "NSM"}},
    {nastran_square + "MAT1,9,2.1E5,9.E4,.3\nPSHELL,7,9,2.,9\n", {"MAT1 9", "isotropic"}},
    {nastran_square + "MAT1,9,2.1E5\nPSHELL,7,9,2.,9\n", {"MAT1 9", "two of E, G and NU"}},
    {nastran_square + nastran_steel + "PSHELL,7,9,2.,8\n", {"PSHELL 7", "MID1 and MID2 differ"}},
    {nastran_square + nastran_steel + "PSHELL,7,9,2.,9,,8\n", {"PSHELL 7", "MID1 and MID3 differ"}},
    {nastran_square + nastran_steel + "PSHELL,7,9,2.,9,,9,.8335\n", {"PSHELL 7", "TS/T"}},
    {nastran_square + nastran_steel + "PSHELL,7,9,2.,9,1.0002\n", {"PSHELL 7", "12I/T**3"}},
    {nastran_plate + "CORD2R,0,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n", {"CORD2R 0", "basic system"}},
    {nastran_plate + "CBAR,3,5,1,2,0.,0.,0.\nPBAR,5,9,1.,1.,2.,1.\n", {"CBAR 3", "no vector"}},
    {nastran_plate + "CBAR,3,5,1,2,9\nPBAR,5,9,1.,1.,2.,1.\n", {"CBAR 3", "its G0 is not there"}},
    {nastran_plate + "RBE3,6,,9,123456,1.,12,1,2\n", {"RBE3 6", "other components than 123"}},
    {nastran_plate + "RBE3,6,,9,123456,1,2\n", {"RBE3 6", "weight"}},
    {nastran_plate + "RBE2,6,9,,1,2\n", {"RBE2 6", "components"}},
    {nastran_plate + "RBE3,6,,9,123456,1.,123\n", {"RBE3 6", "no nodes to average"}},
    {nastran_plate + "CBEAM,3,5,1,2,0.,0.,1.\nPBEAM,5,9,1.,1.,2.,,1.\n,0.,0.,0.,0.,0.,0.,0.,0.\n"
                     ",NO,1.,2.,2.,2.\n",
     {"PBEAM 5", "station"}},
    {"SPC1,6,3,1,2,3,4,5,6,7\n", {"line 1", "more than 8 fields"}},
    {"+A,1\n", {"line 1", "continues no entry"}},
    {"GRID    1               0.      0.      0.                              +A\n+B      2\n",
     {"line 2", "continuation B", "asks for A"}},
    {"SPC1    6       3       1                                               +A\n+A      2\n"
     "GRID    1\n+A      3\n",
     {"line 4", "continues line 1, as line 2 does"}}};

INSTANTIATE_TEST_SUITE_P(Nastran, RefusedCard, ::testing::ValuesIn(refused_cards));

}  // namespace
}  // namespace chladni::mesh
