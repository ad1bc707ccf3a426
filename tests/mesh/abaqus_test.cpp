// Input files of Abaqus: what is taken over, and the sentences for what is not.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "mesh/decks/abaqus.hpp"
#include "mesh/own_readers.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::error_of;
using testing::expect_refused;
using testing::expect_words;
using testing::MeshFile;
using testing::Refusal;

Deck deck_of_abaqus(const std::string& text)
{
  return abaqus_deck(abaqus_keywords(text));
}

Declarations declared_by_abaqus(const std::string& text, double length_unit)
{
  const std::vector<Keyword> keywords = abaqus_keywords(text);
  return abaqus_declarations(keywords, abaqus_deck(keywords),
                             {.length = length_unit, .force = 1.0});
}

std::string error_in_abaqus(const std::string& text)
{
  try {
    declared_by_abaqus(text, 1e-3);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const std::string four_nodes = "*Node, nset=All\n1, 0., 0., 0.\n2, 2.\n3, 2., 1.\n4, 0., 1.\n";
const std::string abaqus_square = four_nodes + "*Element, type=S4R, elset=Plate\n1, 1, 2, 3, 4\n";
const std::string abaqus_steel =
    "*Material, name=Steel\n*Density\n7.85e-9,\n*Elastic\n210000., 0.3\n";
const std::string abaqus_plate =
    abaqus_square + abaqus_steel + "*Shell Section, elset=Plate, material=Steel\n2., 5\n";

TEST(AbaqusDeck, NamesItsGroupsBySetsAndSections)
{
  const Mesh mesh = mesh_of(
      deck_of_abaqus("*Heading\n** a comment\n" + abaqus_plate +
                     "*Nset, nset=Edge\n1, 2\n*Nset, nset=Plate, generate\n1, 3, 2\n"
                     "*Nset, nset=Both\nEdge, 4\n*Element, type=B31, elset=Rib\n7, 1, 2\n"
                     "*Elset, elset=Rest,\ninternal\n1\n*Surface, type=node, name=S\nEdge, 1.\n"
                     "*Boundary\n3, 1, 3\n*Step\n*Whatever\n*End Step\n"),
      {.line_groups = {"RIB"}});
  EXPECT_EQ(find_group(mesh, "PLATE").nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(find_group(mesh, "PLATE").dimension, 2);
  EXPECT_EQ(find_group(mesh, "PLATE_nodes").nodes, (std::vector<int>{0, 2}));
  EXPECT_EQ(find_group(mesh, "EDGE").nodes, (std::vector<int>{0, 1}));
  EXPECT_EQ(find_group(mesh, "BOTH").nodes, (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(find_group(mesh, "RIB").dimension, 1);
  EXPECT_EQ(find_group(mesh, "REST").nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(find_group(mesh, "surface_S").nodes, (std::vector<int>{0, 1}));
  EXPECT_EQ(find_group(mesh, "boundary_3").nodes, (std::vector<int>{2}));
  ASSERT_FALSE(mesh.notes.empty());
  EXPECT_NE(mesh.notes[0].find("steps are left out"), std::string::npos);
}

class AbaqusFile : public MeshFile {};

TEST_F(AbaqusFile, IsReadInItsUnitByAProcessOfItsOwn)
{
  const std::string curved = four_nodes + "5, 1.\n6, 2., .5\n7, 1., 1.\n8, 0., .5\n9, 1., .5\n";
  const std::vector<std::string> elements{"S4R\n1, 1, 2, 3, 4\n", "S3\n1, 1, 2, 3\n2, 1, 3, 4\n",
                                          "S8R\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n",
                                          "STRI65\n1, 1, 2, 3, 5, 6, 9\n2, 1, 3, 4, 9, 7, 8\n"};
  for (const std::string& of_kind : elements) {
    const std::string file = write("a.inp", curved + "*ELEMENT, TYPE=" + of_kind);
    const Mesh mesh = generate({.file = file, .length_unit = 1e-3});
    EXPECT_NEAR(area(mesh), 2e-6, 1e-18) << of_kind;
  }
  const Declarations declared =
      declarations({.file = write("b.inp", abaqus_plate)}, {.length = 1e-3, .force = 1.0});
  EXPECT_EQ(declared.shells.size(), 1U);
}

TEST_F(AbaqusFile, ErrorsNameFileLineAndKeyword)
{
  const std::string file =
      write("a.inp", abaqus_square + "*Element, type=C3D5\n2, 1, 2, 3, 4, 5\n");
  expect_words(error_of({.file = file}), {"a.inp", "line 8", "*ELEMENT", "C3D5", "hexahedra"});
  expect_words(error_of({.file = path("absent.inp")}), {"absent.inp", "does not exist"});
}

TEST(AbaqusLines, OfThreeNodesAreOfOrderTwo)
{
  const Mesh mesh = mesh_of(
      deck_of_abaqus("*Node\n1, 0.\n2, 1.\n3, 2.\n*Element, type=B32, elset=Rib\n1, 1, 2, 3\n"),
      {.line_groups = {"RIB"}});
  EXPECT_EQ(mesh.blocks.at(0).order, 2);
  EXPECT_EQ(mesh.blocks.at(0).nodes, (std::vector<int>{0, 1, 2}));
}

TEST(AbaqusDeclarations, AreInSI)
{
  const Declarations in_mm = declared_by_abaqus(
      abaqus_square + abaqus_steel +
          "*Shell Section, elset=Plate, material=Steel, offset=SPOS\n2., 5\n"
          "*Element, type=B31, elset=Rib\n7, 1, 2\n"
          "*Beam Section, elset=Rib, material=Steel, section=RECT\n4., 2.\n0., 0., 1.\n"
          "*Element, type=B31, elset=Tube\n8, 1, 2\n"
          "*Beam Section, elset=Tube, material=Steel, section=PIPE\n5., 1.\n",
      1e-3);
  EXPECT_NEAR(in_mm.materials.at(0).young, 2.1e11, 1.0);
  EXPECT_NEAR(in_mm.materials.at(0).density, 7850.0, 1e-9);
  EXPECT_DOUBLE_EQ(in_mm.shells.at(0).thickness, 2e-3);
  EXPECT_DOUBLE_EQ(in_mm.shells.at(0).offset, -1e-3) << "the nodes are on the positive side";
  const DeclaredBeam& rib = in_mm.beams.at(0);
  EXPECT_NEAR(rib.area, 8e-6, 1e-18);
  EXPECT_NEAR(rib.I_y, 4.0 * 4.0 * 4.0 * 2.0 / 12.0 * 1e-12, 1e-24) << "4 mm along n1, which is z";
  EXPECT_NEAR(rib.I_z, 4.0 * 2.0 * 2.0 * 2.0 / 12.0 * 1e-12, 1e-24);
  EXPECT_NEAR(rib.J, 7.32e-12, 0.02e-12);  // Roark: 0.229 a b^3 for sides of 2 : 1
  const DeclaredBeam& tube = in_mm.beams.at(1);
  EXPECT_NEAR(tube.J, std::numbers::pi / 2.0 * (625.0 - 256.0) * 1e-12, 1e-22);
}

TEST(AbaqusDeclarations, HoldTheReferenceNodeOfACoupling)
{
  const std::string coupling =
      "*Node\n9, 1., .5\n*Nset, nset=Ref\n9\n*Nset, nset=Edge\n1, 2\n"
      "*Surface, type=NODE, name=S\nEdge\n*Coupling, constraint name=C, ref node=Ref, surface=S\n";
  const Declarations rigid = declared_by_abaqus(
      abaqus_plate + coupling + "*Kinematic\n1, 6\n*Boundary\nRef, ENCASTRE\n3, 1, 2\n", 1.0);
  ASSERT_EQ(rigid.couplings.size(), 1U);
  EXPECT_EQ(rigid.couplings[0].name, "node_9");
  EXPECT_EQ(rigid.couplings[0].group, "surface_S");
  EXPECT_EQ(rigid.couplings[0].kind, CouplingOfDeck::rigid);
  EXPECT_EQ(rigid.couplings[0].at, (std::array<double, 3>{1.0, 0.5, 0.0}));
  ASSERT_EQ(rigid.supports.size(), 2U);
  EXPECT_EQ(rigid.supports[0].group, "node_9");
  EXPECT_EQ(rigid.supports[0].components.size(), 6U);
  EXPECT_EQ(rigid.supports[1].group, "boundary_3");
  EXPECT_EQ(rigid.supports[1].components, (std::vector<int>{0, 1}));
  EXPECT_EQ(declared_by_abaqus(abaqus_plate + coupling + "*Distributing\n", 1.0).couplings[0].kind,
            CouplingOfDeck::averaging);
}

TEST(AbaqusDeclarations, HaveRigidBodiesAndConstraintsAsCouplings)
{
  const std::string nodes = "*Node\n9, 1., .5\n10, 2., 1.\n*Nset, nset=Edge\n1, 2\n";
  const Declarations declared = declared_by_abaqus(
      abaqus_plate + nodes + "*Rigid body, ref node=9, tie nset=Edge\n*MPC\nTIE, 10, 3\n", 1.0);
  ASSERT_EQ(declared.couplings.size(), 2U);
  EXPECT_EQ(declared.couplings[0].name, "node_9");
  EXPECT_EQ(declared.couplings[0].group, "rigid_body_9");
  EXPECT_EQ(declared.couplings[1].group, "mpc_3");
  EXPECT_EQ(declared.couplings[1].to, "leader_3");
  const Deck deck = deck_of_abaqus(abaqus_plate + nodes +
                                   "*Rigid body, ref node=1, elset=Plate\n*MPC\nBEAM, Edge, 9\n"
                                   "BEAM, 4, 9\n");
  const auto group = [&](const std::string& name) {
    return std::ranges::find(deck.groups, name, &DeckGroup::name)->nodes;
  };
  EXPECT_EQ(group("rigid_body_1"), (std::vector<std::int64_t>{2, 3, 4}));
  EXPECT_EQ(group("mpc_9"), (std::vector<std::int64_t>{1, 2, 4}));
  EXPECT_EQ(deck.couplings.size(), 2U);
}

TEST(AbaqusKeywords, MayHaveBlanksAndGoOnBehindAComma)
{
  const std::vector<Keyword> keywords = abaqus_keywords(
      "*NSET , NSET = Held ,\n1, 8\n* Nset, nset=A,\n generate , internal\n1, 3\n"
      "*Shell\tSection, Elset =P,\nMaterial= \"my steel\"\n2.\n");
  ASSERT_EQ(keywords.size(), 3U);
  EXPECT_EQ(keywords[0].parameter("NSET"), "HELD");
  EXPECT_EQ(keywords[0].rows.size(), 1U);
  EXPECT_TRUE(keywords[1].has("GENERATE"));
  EXPECT_EQ(keywords[1].rows.size(), 1U);
  EXPECT_EQ(keywords[2].name, "SHELL SECTION");
  EXPECT_EQ(keywords[2].parameter("MATERIAL"), "MY STEEL");
}

TEST(AbaqusDeck, HasSurfacesOfElementNumbersAndEdges)
{
  const Mesh mesh = mesh_of(
      deck_of_abaqus(abaqus_plate + "*Surface, name=S\n1, SPOS\n*Surface, name=E\nPLATE, E2\n"),
      {});
  EXPECT_EQ(find_group(mesh, "surface_S").nodes.size(), 4U);
  EXPECT_EQ(find_group(mesh, "surface_E").nodes, (std::vector<int>{1, 2}));
}

TEST(AbaqusDeclarations, HaveTheSupportsOfTheFirstStep)
{
  const std::string steps =
      "*Step, perturbation\n*Frequency\n5,\n*Nset, nset=Held\n1, 2\n*Boundary, op=MOD\n"
      "Held, ENCASTRE\n*End Step\n*Step\n*Boundary\n3, 1\n*End Step\n";
  const Declarations declared = declared_by_abaqus(abaqus_plate + steps, 1.0);
  ASSERT_EQ(declared.supports.size(), 1U);
  EXPECT_EQ(declared.supports[0].group, "HELD");
  const Deck deck = deck_of_abaqus(abaqus_plate + steps);
  ASSERT_EQ(deck.notes.size(), 2U);
  expect_words(deck.notes[1], {"line 24", "later step"});
}

const std::string part = "*Part, name=P\n" + abaqus_square +
                         "*Nset, nset=Edge\n1, 4\n*Shell Section, elset=Plate, material=Steel\n2.\n"
                         "*End Part\n";

/// The second instance stands at x = 10, turned by 90 degrees about z through (10, 0, 0).
TEST(AbaqusDeck, HasInstancesOfParts)
{
  const std::string assembly =
      "*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n"
      "*Instance, name=P-2, part=P\n10., 0., 0.\n10., 0., 0., 10., 0., 1., 90.\n*End Instance\n"
      "*Node, nset=Ref\n1, 7., 7., 7.\n*Nset, nset=Far, instance=P-2\n2, 3\n"
      "*Nset, nset=Far, instance=P-1\nEdge\n*Surface, type=NODE, name=S\nFar\n"
      "*Coupling, constraint name=C, ref node=Ref, surface=S\n*Kinematic\n*End Assembly\n" +
      abaqus_steel + "*Boundary\nP-1.Edge, 1\nP-2.3, 2\n";
  const Deck deck = deck_of_abaqus(part + assembly);
  EXPECT_EQ(deck.nodes.size(), 9U);
  EXPECT_EQ(deck.nodes.at(2), (std::array<double, 3>{2.0, 0.0, 0.0}));
  EXPECT_NEAR(deck.nodes.at(12)[0], 10.0, 1e-14);
  EXPECT_NEAR(deck.nodes.at(12)[1], 2.0, 1e-14);
  EXPECT_EQ(deck.nodes.at(21)[2], 7.0);
  expect_words(deck.notes.at(0), {"P-2", "from 10 on"});
  const Declarations declared = declared_by_abaqus(part + assembly, 1.0);
  ASSERT_EQ(declared.shells.size(), 2U);
  EXPECT_EQ(declared.shells[1].group, "P-2.PLATE");
  EXPECT_EQ(declared.supports.at(0).group, "P-1.EDGE");
  EXPECT_EQ(declared.supports.at(1).group, "boundary_13");
  EXPECT_EQ(declared.couplings.at(0).name, "node_21");
  const Mesh mesh = mesh_of(deck, {});
  EXPECT_EQ(find_group(mesh, "surface_S").nodes.size(), 4U);
  EXPECT_NEAR(area(mesh), 4.0, 1e-14);
}

/// A cube of side 2 with corners 1 to 8, and 11 to 22 in the middle of its edges.
const std::string cube_nodes =
    "*Node\n1, 0., 0., 0.\n2, 2., 0., 0.\n3, 2., 2., 0.\n4, 0., 2., 0.\n5, 0., 0., 2.\n6, 2., 0., "
    "2.\n"
    "7, 2., 2., 2.\n8, 0., 2., 2.\n11, 1., 0., 0.\n12, 2., 1., 0.\n13, 1., 2., 0.\n14, 0., 1., 0.\n"
    "15, 1., 0., 2.\n16, 2., 1., 2.\n17, 1., 2., 2.\n18, 0., 1., 2.\n19, 0., 0., 1.\n20, 2., 0., "
    "1.\n"
    "21, 2., 2., 1.\n22, 0., 2., 1.\n";
const std::string cube =
    cube_nodes +
    "*Element, type=C3D20R, elset=Body\n1, 1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, "
    "14, 15, 16, 17\n18, 19, 20, 21, 22\n";
const std::string solid_section = abaqus_steel + "*Solid Section, elset=Body, material=Steel\n,\n";
const std::string tetrahedron = cube_nodes + "*Element, type=C3D4, elset=Body\n1, 1, 2, 4, 5\n";

TEST(AbaqusSolids, AreTheElementsOfFullIntegrationAndHaveASection)
{
  const Deck deck = deck_of_abaqus(cube + solid_section);
  const Mesh mesh = mesh_of(deck, {.solid_groups = {"BODY"}});
  ASSERT_EQ(mesh.blocks.size(), 1U);
  EXPECT_EQ(mesh.blocks[0].shape, Shape::hexahedron);
  EXPECT_EQ(mesh.blocks[0].order, 2);
  EXPECT_EQ(mesh.node_numbers[std::size_t(mesh.blocks[0].nodes[19])], 22);
  EXPECT_EQ(find_group(mesh, "BODY").dimension, 3);
  expect_words(deck.notes.at(0), {"1 elements C3D20R", "full integration"});
  const Declarations declared = declared_by_abaqus(cube + solid_section, 1e-3);
  ASSERT_EQ(declared.solids.size(), 1U);
  EXPECT_EQ(declared.solids[0].group, "BODY");
  EXPECT_EQ(declared.solids[0].material, "STEEL");
}

TEST(AbaqusSolids, HaveSurfacesOfFaces)
{
  // The plane in which the nodes of each face of the cube are.
  const std::array<std::pair<std::size_t, double>, 6> planes{
      {{2, 0.0}, {2, 2.0}, {1, 0.0}, {0, 2.0}, {1, 2.0}, {0, 0.0}}};
  for (std::size_t f = 0; f < planes.size(); ++f) {
    const std::string surface = fmt::format("*Surface, name=F, type=ELEMENT\nBody, S{}\n", f + 1);
    const Mesh mesh = mesh_of(deck_of_abaqus(cube + surface), {});
    const Group& group = find_group(mesh, "surface_F");
    EXPECT_EQ(group.dimension, 2);
    EXPECT_EQ(group.nodes.size(), 8U);
    const auto& [axis, value] = planes[f];
    for (const int node : group.nodes)
      EXPECT_EQ(mesh.positions[std::size_t(node)][axis], value) << surface;
  }
}

/// The middle of an edge inside of the body would not be held, though both ends are.
TEST(AbaqusSolids, OfFourNodesGetMiddlesThatAreHeldOnTheSkinAlone)
{
  const std::string two =
      tetrahedron + "*Node\n30, 1., 1., 1.\n*Element, type=C3D4, elset=Body\n2, 2, 30, 4, 5\n" +
      "*Nset, nset=Face\n1, 2, 4\n*Nset, nset=Edge\n2, 4\n";
  const Mesh mesh = mesh_of(deck_of_abaqus(two), {});
  ASSERT_EQ(mesh.blocks.size(), 1U);
  EXPECT_EQ(mesh.blocks[0].order, 2);
  EXPECT_EQ(mesh.n_nodes(), 5 + 9);
  EXPECT_EQ(find_group(mesh, "FACE").nodes.size(), 6U);
  EXPECT_EQ(find_group(mesh, "EDGE").nodes.size(), 3U);
  EXPECT_NE(mesh.notes.at(0).find("far too stiff"), std::string::npos);
}

TEST(AbaqusSolids, FollowAKinematicCouplingOfThreeComponents)
{
  const std::string coupling =
      "*Node, nset=Ref\n9, 1., 1., 5.\n*Surface, name=Top\nBody, S2\n"
      "*Coupling, constraint name=C, ref node=Ref, surface=Top\n*Kinematic\n1, 3\n";
  const Declarations declared = declared_by_abaqus(cube + solid_section + coupling, 1.0);
  ASSERT_EQ(declared.couplings.size(), 1U);
  EXPECT_EQ(declared.couplings[0].kind, CouplingOfDeck::rigid);
  const std::string of_shells =
      abaqus_plate + "*Node, nset=Ref\n9, 1., 1., 5.\n*Surface, name=Top\nPlate, SPOS\n" +
      "*Coupling, constraint name=C, ref node=Ref, surface=Top\n*Kinematic\n1, 3\n";
  EXPECT_TRUE(declared_by_abaqus(of_shells, 1.0).couplings.empty());
  EXPECT_EQ(deck_of_abaqus(of_shells).equations.size(), 12U) << "three of each of four nodes";
}

TEST(AbaqusDeck, HasEquationsOfNodesAndSets)
{
  const Deck deck = deck_of_abaqus(abaqus_plate + "*Nset, nset=A\n1, 2\n*Nset, nset=B\n3, 4\n" +
                                   "*Equation\n3\nA, 1, 1., B, 2, -0.5,\n1, 6, 2.\n" +
                                   "2\n1, 11, 1., 2, 11, -1.\n");
  ASSERT_EQ(deck.equations.size(), 2U) << "one for each node of the sets, none of temperatures";
  const auto& terms = deck.equations[1].terms;
  ASSERT_EQ(terms.size(), 3U);
  EXPECT_EQ(terms[0].node, 2);
  EXPECT_EQ(terms[1].node, 4);
  EXPECT_EQ(terms[1].component, 1);
  EXPECT_EQ(terms[1].factor, -0.5);
  EXPECT_EQ(terms[2].node, 1);
  Mesh mesh = mesh_of(deck, {});
  scale(mesh, 1e-3);
  EXPECT_DOUBLE_EQ(mesh.equations.at(0).terms[2].factor, 2e-3) << "of a rotation, beside metres";
}

TEST(AbaqusDeck, KeepsTheOrderOfUnsortedSetsInEquations)
{
  const Deck deck =
      deck_of_abaqus(abaqus_plate + "*Nset, nset=A\n2, 1\n*Nset, nset=B, unsorted\n4\n" +
                     "3\n*Equation\n2\nA, 1, 1., B, 1, -1.\n");
  ASSERT_EQ(deck.equations.size(), 2U);
  EXPECT_EQ(deck.equations[0].terms[0].node, 1) << "sorted";
  EXPECT_EQ(deck.equations[0].terms[1].node, 4);
  EXPECT_EQ(deck.equations[1].terms[1].node, 3);
}

/// Nodes 1 and 2 are 2 apart in x: a spring of the scene across it would act at (1, 0).
TEST(AbaqusDeck, HasTheDifferenceOfASpringAcrossADistanceAsAnEquation)
{
  const std::string text =
      abaqus_plate + "*Element, type=SPRING2, elset=S\n11, 1, 2\n" + "*Spring, elset=S\n2, 2\n5.\n";
  const Deck deck = deck_of_abaqus(text);
  ASSERT_EQ(deck.equations.size(), 1U);
  const auto& terms = deck.equations[0].terms;
  ASSERT_EQ(terms.size(), 3U);
  EXPECT_EQ(terms[0].node, 5) << "beyond the nodes of the deck";
  EXPECT_EQ(terms[1].factor * terms[2].factor, -1.0);
  for (const auto& term : terms) EXPECT_EQ(term.component, 1);
  const Declarations declared = declared_by_abaqus(text, 1.0);
  ASSERT_EQ(declared.springs.size(), 1U);
  EXPECT_EQ(declared.springs[0].at, "spring_11_1");
  EXPECT_FALSE(declared.springs[0].to);
  EXPECT_DOUBLE_EQ(declared.springs[0].stiffness[1], 5.0);
}

const std::string with_rot_node = abaqus_plate +
                                  "*Node\n9, 0., 0., 5.\n10, 0., 0., 5.\n*Nset, nset=Rot\n10\n" +
                                  "*Rigid body, ref node=9, rot node=10, tie nset=All\n";

TEST(AbaqusDeclarations, HoldRotationsByTheSetOfARotNode)
{
  const Declarations declared = declared_by_abaqus(with_rot_node + "*Boundary\nRot, 1, 2\n", 1.0);
  ASSERT_EQ(declared.supports.size(), 1U);
  EXPECT_EQ(declared.supports[0].group, "node_9");
  EXPECT_EQ(declared.supports[0].components, (std::vector<int>{3, 4}));
  EXPECT_TRUE(declared.notes.empty());
}

TEST(AbaqusDeclarations, HaveMassesAndSpringsToNodesAndTheGround)
{
  const std::string points =
      "*Node\n8, 2., 0., -1.\n9, 2., 3., 0.\n*Element, type=MASS, elset=M\n10, 3\n*Mass, elset=M\n"
      "2e-3\n*Element, type=SPRINGA, elset=S\n11, 8, 2\n*Spring, elset=S\n\n5., 1.\n"
      "*Element, type=SPRING2, elset=T\n12, 1, 2\n*Spring, elset=T\n6, 6\n7.\n*Boundary\n8, 1, 3\n"
      "*Element, type=DASHPOTA, elset=D\n13, 1, 3\n*Dashpot, elset=D\n\n1.\n";
  const Declarations declared = declared_by_abaqus(abaqus_plate + points, 1e-3);
  ASSERT_EQ(declared.masses.size(), 1U);
  EXPECT_EQ(declared.masses[0].at, "mass_10");
  EXPECT_DOUBLE_EQ(declared.masses[0].mass, 2.0) << "t in the deck";
  ASSERT_EQ(declared.springs.size(), 2U);
  EXPECT_EQ(declared.springs[0].at, "spring_11_2") << "node 8 belongs to no element and is held";
  EXPECT_FALSE(declared.springs[0].to);
  EXPECT_DOUBLE_EQ(declared.springs[0].stiffness[2], 5e3);
  EXPECT_EQ(declared.springs[1].to, "spring_12_2");
  EXPECT_DOUBLE_EQ(declared.springs[1].stiffness[5], 7e-3);
}

/// Of nodes 1 (0, 0) and 3 (2, 1): along (2, 1) / sqrt(5).
TEST(AbaqusDeck, HasTheElongationOfASkewSpringAsAnEquation)
{
  const Deck deck = deck_of_abaqus(abaqus_plate + "*Element, type=SPRINGA, elset=S\n11, 1, 3\n" +
                                   "*Spring, elset=S\n\n5.\n");
  ASSERT_EQ(deck.equations.size(), 2U)
      << "elongation, and a turn about the line, which both nodes have";
  const auto& terms = deck.equations[0].terms;
  ASSERT_EQ(terms.size(), 5U);
  EXPECT_EQ(terms[0].node, 5) << "beyond the nodes of the deck";
  EXPECT_NEAR(terms[1].factor, 2.0 / std::sqrt(5.0), 1e-15);
  EXPECT_NEAR(terms[3].factor, -2.0 / std::sqrt(5.0), 1e-15);
}

TEST(AbaqusDeclarations, HaveNodalThicknessesAsATable)
{
  const Declarations declared =
      declared_by_abaqus(abaqus_plate + "*Nodal thickness\nAll, 2.\n2, 3.\n3, 3.\n", 1e-3);
  ASSERT_TRUE(declared.shells.at(0).table);
  EXPECT_EQ(declared.shells[0].table->over, "x");
  EXPECT_EQ(declared.shells[0].table->values, (std::vector<double>{2e-3, 3e-3}));
  const Declarations by_radius =
      declared_by_abaqus(abaqus_plate + "*Nodal thickness\nAll, 2.\n2, 3.\n", 1e-3);
  EXPECT_EQ(by_radius.shells.at(0).table->over, "radius") << "of four nodes with four radii";
}

/// By Bredt: J = 4 A^2 / sum l / t.
TEST(AbaqusDeclarations, HaveBoxes)
{
  const Declarations declared = declared_by_abaqus(
      abaqus_plate + "*Element, type=B31, elset=Rib\n7, 1, 2\n" +
          "*Beam General Section, elset=Rib, material=Steel, section=BOX\n5., 3., .2, .1, .2, .1\n",
      1.0);
  EXPECT_NEAR(declared.beams.at(0).area, 15.0 - 4.6 * 2.8, 1e-12);
  EXPECT_NEAR(declared.beams[0].J,
              4.0 * std::pow(4.8 * 2.9, 2) / (2.0 * 4.8 / 0.1 + 2.0 * 2.9 / 0.2), 1e-9);
}

TEST(AbaqusDeclarations, HaveOnlyTheNewSupportsOfTheFirstStep)
{
  const Declarations declared = declared_by_abaqus(
      abaqus_plate + "*Boundary\n1, 1\n*Step\n*Boundary, op=NEW\n2, 1, 1, .5\n*End Step\n", 1.0);
  ASSERT_EQ(declared.supports.size(), 1U);
  EXPECT_EQ(declared.supports[0].group, "boundary_2");
  expect_words(declared.notes.at(0), {"prescribes a displacement", "held at zero"});
}

TEST(AbaqusSolids, AreLeftOutWhereOnlyShellsHaveSections)
{
  const std::string both = cube + "*Element, type=S4, elset=Plate\n7, 1, 2, 3, 4\n";
  const Mesh of_shells = mesh_of(deck_of_abaqus(both), {.shell_groups = {"PLATE"}});
  ASSERT_EQ(of_shells.blocks.size(), 1U);
  EXPECT_EQ(of_shells.blocks[0].shape, Shape::quadrilateral);
  expect_words(of_shells.notes.at(1), {"1 solid elements are left out"});
  const Mesh of_solids = mesh_of(deck_of_abaqus(both), {.solid_groups = {"BODY"}});
  ASSERT_EQ(of_solids.blocks.size(), 1U);
  EXPECT_EQ(of_solids.blocks[0].shape, Shape::hexahedron);
  EXPECT_EQ(find_group(of_solids, "PLATE").nodes.size(), 4U);
  const Mesh of_both =
      mesh_of(deck_of_abaqus(both), {.shell_groups = {"PLATE"}, .solid_groups = {"BODY"}});
  EXPECT_EQ(of_both.blocks.size(), 2U);
}

/// Gmsh writes the elements of each volume under a name of its own, and its groups as sets of them.
TEST(AbaqusSolids, MayHaveTheirSectionByASetThatTheDeckGivesNone)
{
  const std::string sets =
      tetrahedron + "*Element, type=CPS3, elset=Surface1\n2, 1, 2, 4\n" + "*Elset, elset=Disc\n1\n";
  const Mesh mesh = mesh_of(deck_of_abaqus(sets), {.solid_groups = {"DISC"}});
  const int group = mesh.blocks.at(0).group.at(0);
  EXPECT_EQ(mesh.groups[std::size_t(group)].name, "DISC");
  EXPECT_EQ(find_group(mesh, "DISC").dimension, 3);
  EXPECT_EQ(find_group(mesh, "SURFACE1").nodes.size(), 6U);
}

TEST(AbaqusSolids, MayEndWithACommaAndHaveWhatVibrationsDoNotNeed)
{
  const std::string with_comma = cube_nodes + "*Element, type=C3D4, elset=Body\n1, 1, 2, 4, 5,\n";
  const std::string text = with_comma + "*Orientation, name=O\n1., 0., 0., 0., 1., 0.\n" +
                           "*Material, name=Steel\n*Expansion\n1e-5,\n*Elastic\n210000., 0.3\n"
                           "*Conductivity\n50.,\n*Density\n7.85e-9,\n"
                           "*Solid Section, elset=Body, material=Steel, orientation=O\n"
                           "*Initial Conditions, type=Temperature\n1, 20.\n";
  const Deck deck = deck_of_abaqus(text);
  EXPECT_EQ(deck.elements.size(), 1U);
  ASSERT_EQ(deck.notes.size(), 4U);
  expect_words(deck.notes[1], {"1 *EXPANSION", "left out"});
  EXPECT_GT(declared_by_abaqus(text, 1.0).materials.at(0).density, 0.0);
}

TEST(AbaqusDeclarations, TakeWhatStaticDecksHave)
{
  const std::string text =
      abaqus_square +
      "*Restart, write\n*Material, name=Steel\n*Elastic\n210000., 0.3, 20.\n190000., 0.31, 300.\n"
      "*Plastic\n300., 0., 20.\n*Damping, alpha=2.\n*Shell Section, elset=Plate, "
      "material=Steel\n2.\n"
      "*Boundary, amplitude=A\n1, 1, 3\n2, 11, 11, 300.\n";
  const Declarations declared = declared_by_abaqus(text, 1.0);
  EXPECT_DOUBLE_EQ(declared.materials.at(0).young, 210000.0);
  EXPECT_DOUBLE_EQ(declared.materials.at(0).poisson, 0.3);
  EXPECT_DOUBLE_EQ(declared.materials.at(0).density, 0.0);
  ASSERT_EQ(declared.supports.size(), 1U);
  EXPECT_EQ(declared.supports[0].components.size(), 3U);
  std::string said;
  for (const std::string& note : declared.notes) said += note + "\n";
  for (const std::string& note : deck_of_abaqus(text).notes) said += note + "\n";
  expect_words(said, {"*ELASTIC has values for 2 temperatures; those at 20. count", "no density",
                      "material.STEEL", "1 *PLASTIC", "*DAMPING is left out", "1 *RESTART"});
}

class RefusedSolid : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedSolid, IsNamedWithItsLine)
{
  try {
    mesh_of(deck_of_abaqus(GetParam().text), {});
    FAIL() << GetParam().text;
  } catch (const Error& error) {
    expect_refused(GetParam(), error.what());
  }
}

const std::string c3d4 = cube_nodes + "*Element, type=C3D4, elset=Body\n";
const std::vector<Refusal> refused_solids{
    {c3d4 + "1, 1, 4, 2, 5\n", {"line 23", "element 1 is inside out", "first 3 nodes"}},
    {c3d4 + "1, 1, 2, 4, 4\n", {"line 23", "element 1 has the node 4 twice"}},
    {c3d4 + "1, 1, 2, 4, 99\n", {"line 23", "element 1: its node 99 is not there"}},
    {c3d4 + "1, 1, 2, 4, 5, 11\n", {"line 23", "4 nodes"}},
    {cube_nodes + "*Element, type=C3D10, elset=Body\n1, 1, 2, 4, 5, 11, 12, 13, 14, 19\n",
     {"line 23", "10 nodes"}},
    {tetrahedron + "*Surface, name=F\n1, S5\n", {"line 25", "element 1 has no face S5"}},
    {tetrahedron + "*Surface, name=F\n1,\n", {"line 25", "is a solid; name its face"}},
    {cube + "*Element, type=C3D8\n2, 4, 3, 31, 32, 8, 7, 33, 34\n*Node\n31, 2., 4., 0.\n"
            "32, 0., 4., 0.\n33, 2., 4., 2.\n34, 0., 4., 2.\n",
     {"line 24: element 1 has a node between 3 and 4", "line 26: element 2 has none"}},
    {tetrahedron + "*Initial Conditions, type=Stress\n1, 20.\n", {"line 24", "prestresses"}},
    {cube + "*Element, type=S4, elset=Plate\n7, 1, 2, 3, 4\n" + abaqus_steel +
         "*Solid Section, elset=Plate, material=Steel\n",
     {"*SOLID SECTION", "element 7 of the type S4"}}};

INSTANTIATE_TEST_SUITE_P(Abaqus, RefusedSolid, ::testing::ValuesIn(refused_solids));

TEST(AbaqusDeclarations, RefuseAVolumeWithoutASection)
{
  expect_words(
      error_in_abaqus(cube + "*Element, type=C3D4, elset=Rest\n2, 1, 2, 4, 5\n" + solid_section),
      {"line 26", "element 2 is of \"REST\"", "no section"});
}

class RefusedKeyword : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedKeyword, IsNamedWithItsLine)
{
  expect_refused(GetParam(), error_in_abaqus(GetParam().text));
}

const std::vector<Refusal> refused_keywords{
    {abaqus_plate + "*Spring, elset=a\n", {"line 15", "*SPRING", "no element set \"A\""}},
    {abaqus_plate + "*Part, name=P\n", {"*PART", "END PART"}},
    {abaqus_plate + "*Assembly, name=A\n*Instance, name=I, part=P\n*End Instance\n",
     {"line 16", "*INSTANCE", "no part \"P\""}},
    {abaqus_plate + "*Include, input=more.inp\n", {"line 15", "more.inp"}},
    {abaqus_plate + "*Surface, name=S\n17, SPOS\n", {"line 16", "no element 17"}},
    {abaqus_plate + "*Surface, name=S\n1, S3\n", {"line 16", "element 1 has no face S3"}},
    {abaqus_plate + "*Surface, name=S\n1, T3\n", {"line 16", "SPOS or SNEG"}},
    {abaqus_plate + "*Node, system=C\n5, 1.\n", {"*NODE", "SYSTEM"}},
    {abaqus_plate + "*Node\n1, 1.\n", {"line 16", "node 1", "twice"}},
    {abaqus_plate + "*Node\n5, a\n", {"line 16", "\"A\" is no number"}},
    {abaqus_plate + "*Node\n0, 1.\n", {"\"0\" is no number of a node"}},
    {abaqus_plate + "*Element, type=S4\n5, 1, 2, 3\n", {"line 16", "4 nodes"}},
    {abaqus_plate + "*Element, type=S4\n1, 1, 2, 3, 4\n", {"element 1", "twice"}},
    {abaqus_plate + "*Element, type=S9R5\n", {"S9R5", "not known"}},
    {abaqus_plate + "*Element, type=S4, offset=0.5\n5, 1, 2, 3, 4\n", {"*ELEMENT", "OFFSET"}},
    {abaqus_plate + "*Element, type=S4\n5, 1, 2, 3,\n", {"ends with a comma"}},
    {abaqus_plate + "*Element, type=B31, elset=Plate\n5, 1, 2\n",
     {"*SHELL SECTION", "\"PLATE\"", "element 5", "B31"}},
    {abaqus_plate + "*Nset, nset=N\nAbsent\n", {"line 16", "no set \"ABSENT\""}},
    {abaqus_plate + "*Nset, nset=N, generate\n5, 1\n", {"line 16", "no range"}},
    {abaqus_plate + "*Boundary\nAbsent, 1\n", {"no node set \"ABSENT\""}},
    {abaqus_plate + "*Boundary\n1, 5, 9\n", {"no components"}},
    {abaqus_plate + "*Boundary, type=velocity\n1, 1\n", {"*BOUNDARY", "TYPE"}},
    {abaqus_plate + "*Shell Section, elset=Plate, material=Steel\n2.\n",
     {"element 1 has two sections"}},
    {abaqus_square + abaqus_steel + "*Shell Section, elset=Plate, material=Steel, composite\n2.\n",
     {"*SHELL SECTION", "COMPOSITE"}},
    {abaqus_square + abaqus_steel + "*Shell Section, elset=Absent, material=Steel\n2.\n",
     {"\"ABSENT\""}},
    {abaqus_plate + "*Material, name=B\n*Density\n1.,\n", {"*MATERIAL", "no *ELASTIC"}},
    {abaqus_plate + "*Material, name=B\n*Elastic, type=LAMINA\n1., .3\n",
     {"*ELASTIC", "ISOTROPIC"}},
    {abaqus_plate + "*Material, name=B\n*Elastic\n1., .3\n2., .3, 100.\n",
     {"*ELASTIC", "one data line"}},
    {abaqus_plate + "*Material, name=B\n*Elastic\n1., .3\n*Hyperelastic\n1., 0.\n",
     {"*HYPERELASTIC", "not known"}},
    {abaqus_plate + "*Nset, nset=Ref\n1\n*Surface, type=NODE, name=S\n2\n"
                    "*Coupling, constraint name=C, ref node=Ref, surface=S\n*Distributing\n",
     {"*COUPLING", "node 1 belongs to an element"}},
    {abaqus_plate + "*Element, type=B31, elset=Rib\n7, 1, 2\n"
                    "*Beam Section, elset=Rib, material=Steel, section=L\n4., 2., 1., 1.\n",
     {"*BEAM SECTION", "the profile L"}},
    {abaqus_plate + "*Rigid body, ref node=All, tie nset=All\n", {"*RIGID BODY", "4 nodes"}},
    {abaqus_plate + "*Rigid body, ref node=1, pin nset=All\n", {"*RIGID BODY", "TIE NSET"}},
    {abaqus_plate + "*Rigid body, ref node=1, elset=None\n", {"*RIGID BODY", "no element set"}},
    {abaqus_plate + "*Rigid body, ref node=1, tie nset=All, position=CENTER OF MASS\n",
     {"*RIGID BODY", "POSITION = INPUT"}},
    {abaqus_plate + "*MPC\nSLIDER, 1, 2, 3\n", {"*MPC", "SLIDER", "BEAM and TIE"}},
    {abaqus_plate + "*MPC\nTIE, 1, 2\n", {"*MPC", "1 and 2 are apart"}},
    {abaqus_plate + "*MPC\nBEAM, 1\n", {"*MPC", "one node"}},
    {abaqus_plate + "*Tie, name=T\nA, B\n", {"*TIE", "no surface \"A\""}},
    {abaqus_plate + "*Tie, name=T, cyclic symmetry\nA, B\n", {"*TIE", "sectors = N"}},
    {abaqus_plate + "*Equation\n2\n1, 1, 1.\n", {"line 16", "*EQUATION", "3 numbers"}},
    {abaqus_plate + "*Equation\n2\n1, 7, 1., 2, 1, 1.\n", {"*EQUATION", "7 is no component"}},
    {abaqus_plate + "*Transform, nset=All, type=S\n0., 0., 0., 1., 0., 0.\n",
     {"*TRANSFORM", "R and C"}},
    {abaqus_plate + "*Nset, nset=E\n*Equation\n2\nE, 1, 1., 1, 1, -1.\n",
     {"line 17", "*EQUATION", "the set \"E\" has no nodes"}},
    {abaqus_plate + "*Equation\n2\n1, 1, 1., All, 1, -1.\n",
     {"line 16", "*EQUATION", "\"ALL\" has 4 nodes"}},
    {abaqus_plate + "*Nset, nset=U, unsorted\n2, 1, 2\n", {"line 16", "*NSET", "a node twice"}},
    {with_rot_node + "*Element, type=SPRING2, elset=S\n11, 1, 9\n*Spring, elset=S\n1, 1\n5.\n",
     {"line 22", "*ELEMENT", "apart across", "SPRINGA"}},
    {abaqus_plate + "*Node\n8, 2., 0., -1.\n*Nset, nset=N\n8\n*Transform, nset=N\n0., 0., 1., 1.\n"
                    "*Element, type=SPRINGA, elset=S\n11, 2, 8\n*Spring, elset=S\n\n5.\n"
                    "*Boundary\n8, 1\n",
     {"line 27", "*BOUNDARY", "node 8", "*TRANSFORM"}},
    {with_rot_node + "*Nset, nset=Both\n9, 10\n*Boundary\nBoth, 1\n",
     {"line 24", "*BOUNDARY", "ROT NODE among others"}},
    {with_rot_node + "*Equation\n2\n10, 1, 1., 1, 4, -1.\n",
     {"*RIGID BODY", "ROT NODE 10", "*EQUATION"}},
    {with_rot_node + "*Transform, nset=Rot\n0., 1., 0., -1.\n",
     {"*RIGID BODY", "ROT NODE 10", "*TRANSFORM"}},
    {with_rot_node + "*Element, type=MASS, elset=M\n11, 10\n*Mass, elset=M\n1.\n",
     {"*RIGID BODY", "ROT NODE 10", "element 11"}},
    {"*Part, name=P\n" + abaqus_square +
         "*Transform, nset=All\n0., 1., 0., -1.\n*End Part\n*Assembly, name=A\n"
         "*Instance, name=I, part=P\n0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n*End Instance\n",
     {"line 9", "*TRANSFORM", "instance is moved"}},
    {part + "*Assembly, name=A\n*Instance, name=I, part=P\n\n0., 0., 0., 0., 0., 1., 90.\n"
            "*End Instance\n",
     {"line 17", "*INSTANCE", "without a translation"}},
    {"1, 2\n*Node\n", {"line 1", "before the first keyword"}}};

INSTANTIATE_TEST_SUITE_P(Abaqus, RefusedKeyword, ::testing::ValuesIn(refused_keywords));

}  // namespace
}  // namespace chladni::mesh
