#include "cases/sector_frequencies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "cases/chosen_mesh.hpp"
#include "cases/scene_mesh.hpp"
#include "common/error.hpp"
#include "mesh/sectors.hpp"

namespace chladni::cases {
namespace {

using Eigen::VectorXd;

constexpr double two_pi = 2.0 * std::numbers::pi;

/// @param mesh  keys of [mesh] with the groups of its shells
scene::Scene disc(const std::string& mesh, const std::vector<std::string>& groups,
                  const std::string& held)
{
  std::string text = "[mesh]\n" + mesh + R"(
element_order = 2
pattern = "structured"
sectors = "auto"
rings = [{ name = "track", radius = 0.13, nodes = 24 }]
[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0
[interface]
nodes = ["track", "hub"]
[[coupling]]
type = "rigid"
name = "hub"
group = ")" + held + R"("
[[mass]]
at = "hub"
mass = 0.4
inertia = [1e-4, 1e-4, 2e-4, 0.0, 0.0, 0.0]
[reduce]
method = "craig-bampton"
modes = 10
)";
  for (const std::string& group : groups) {
    text += "[[section]]\ntype = \"shell\"\nmaterial = \"iron\"\nthickness = 0.02\ngroup = \"" +
            group + "\"\n";
  }
  return scene::parse_scene(text, "scene.toml");
}

scene::Scene annulus(double element_size)
{
  return disc(
      "generator = \"annulus\"\ninner_radius = 0.025\nouter_radius = 0.162\nelement_size = " +
          std::to_string(element_size),
      {"disc"}, "inner_edge");
}

scene::Scene hat()
{
  return disc(
      "generator = \"hat_disc\"\nouter_radius = 0.162\nwall_radius = 0.09\ntop_radius = 0.085\n"
      "hub_radius = 0.03\nheight = 0.05\nelement_size = 0.04",
      {"disc", "wall", "flange"}, "hub_edge");
}

scene::Scene held(scene::Scene scene, const std::vector<int>& components = {0, 1, 2, 3, 4, 5})
{
  scene.supports = {{.group = "hub", .components = components}};
  return scene;
}

/// Around single held nodes shapes change with each mesh by a fifth, of which one inverse iteration
/// of the whole follows two thirds.
enum class Shapes { compared, left_out };

/// The errors of the whole body, all of one sector's beside them.
void expect_same(const scene::Scene& scene, const mesh::Mesh& mesh, double up_to_Hz,
                 Shapes shapes = Shapes::compared)
{
  const auto sector = SectorFrequencies::find(scene, mesh);
  ASSERT_TRUE(sector.has_value());
  const SupportedModel whole = assemble_supported(scene, mesh);
  EXPECT_EQ(sector->n_dofs(), whole.system.dofs.n_dofs());
  const std::optional<MeshErrors> of_sector = sector->errors_up_to(two_pi * up_to_Hz, {});
  ASSERT_TRUE(of_sector.has_value());
  const MeshErrors& ours = *of_sector;
  const Eigen::Index n = ours.omega.size();
  ASSERT_GT(n, 10);
  const int n_rigid = plate::n_free_motions(whole.free);
  const reduce::NaturalModes modes = reduce::natural_modes(
      whole.system.K, whole.system.M, reduce::free_dofs(whole.system.K, whole.held),
      {.n_modes = n_rigid + int(n), .n_rigid = n_rigid});
  const MeshErrors theirs = mesh_errors(scene, whole, modes);
  ASSERT_EQ(theirs.omega.size(), n);
  EXPECT_LT((ours.omega - theirs.omega).cwiseQuotient(theirs.omega).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LE(ours.omega[n - 1], two_pi * up_to_Hz);
  EXPECT_GT(ours.largest(), 1e-5);
  // The whole's finer modes are one inverse iteration from its own: off by squares of differences.
  EXPECT_LT((ours.errors - theirs.errors).cwiseAbs().maxCoeff(), 0.03 * theirs.largest());
  EXPECT_LT((ours.finer - theirs.finer).cwiseQuotient(theirs.finer).cwiseAbs().maxCoeff(),
            0.03 * theirs.largest());
  ASSERT_EQ(ours.shape_errors.cols(), n);
  if (shapes == Shapes::compared) {
    const double most = theirs.shape_errors.maxCoeff();
    EXPECT_GT(most, 1e-6);
    EXPECT_LT((ours.shape_errors - theirs.shape_errors).cwiseAbs().maxCoeff(), 0.1 * most);
  }
  EXPECT_LT((sector->up_to(two_pi * up_to_Hz, {}) - ours.omega).cwiseAbs().maxCoeff(),
            1e-8 * ours.omega[n - 1]);
}

void expect_same(const scene::Scene& scene, double up_to_Hz)
{
  expect_same(scene, mesh_on_all_ranks(scene), up_to_Hz);
}

/// A disc whose columns of nodes are bent: no mirror takes it to itself.
mesh::Mesh twisted(mesh::Mesh mesh)
{
  for (auto& x : mesh.positions) {
    const double angle = 0.3 * std::hypot(x[0], x[1]), c = std::cos(angle), s = std::sin(angle);
    x = {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
  }
  return mesh;
}

/// The place of some nodes on circles of the mesh, one for each of three equal sectors.
mesh::Group bolts(const mesh::Mesh& mesh)
{
  mesh::Group group{.name = "bolts", .dimension = 0, .nodes = {}};
  for (const auto& [radius, degrees] : {std::pair{0.13, 0.0}, {0.162, 15.0}}) {
    for (int k = 0; k < 3; ++k) {
      const double angle = (degrees + 120.0 * k) * std::numbers::pi / 180.0;
      for (int i = 0; i < mesh.n_nodes(); ++i) {
        const auto& x = mesh.positions[std::size_t(i)];
        if (std::hypot(x[0] - radius * std::cos(angle), x[1] - radius * std::sin(angle)) < 1e-6)
          group.nodes.push_back(i);
      }
    }
  }
  return group;
}

TEST(SectorFrequencies, OfAHeldDiscAreThoseOfTheWhole)
{
  expect_same(held(annulus(0.03)), 6000.0);
}

/// The first harmonics of a free body have rigid motions, and its lowest elastic mode is another's.
TEST(SectorFrequencies, OfARangeBelowTheLowestAreTheLowest)
{
  for (const scene::Scene& scene : {annulus(0.03), held(annulus(0.03))}) {
    const mesh::Mesh mesh = mesh_on_all_ranks(scene);
    const auto sector = SectorFrequencies::find(scene, mesh);
    ASSERT_TRUE(sector.has_value());
    const SupportedModel whole = assemble_supported(scene, mesh);
    const int n_rigid = plate::n_free_motions(whole.free);
    const reduce::NaturalModes modes = reduce::natural_modes(
        whole.system.K, whole.system.M, reduce::free_dofs(whole.system.K, whole.held),
        {.n_modes = n_rigid + 1, .n_rigid = n_rigid});
    const double lowest = std::sqrt(modes.lambda[std::size_t(n_rigid)]);
    const Eigen::VectorXd omega = sector->up_to(0.5 * lowest, {});
    ASSERT_GE(omega.size(), 1);
    EXPECT_LT((omega.array() / lowest - 1.0).abs().maxCoeff(), 1e-8);
  }
}

TEST(SectorFrequencies, OfAFreeHatAreThoseOfTheWhole)
{
  expect_same(hat(), 6000.0);
}

TEST(SectorFrequencies, OfAHeldHatAreThoseOfTheWhole)
{
  expect_same(held(hat()), 6000.0);
}

TEST(SectorFrequencies, OfABodyWithoutMirrorAreThoseOfTheWhole)
{
  const scene::Scene free = annulus(0.03);
  expect_same(held(free), twisted(mesh_on_all_ranks(free)), 6000.0);
  expect_same(free, twisted(mesh_on_all_ranks(free)), 6000.0);
}

TEST(SectorFrequencies, OfASupportWithoutMirrorAreThoseOfTheWhole)
{
  scene::Scene scene = held(annulus(0.03));
  mesh::Mesh mesh = mesh_on_all_ranks(scene);
  mesh.groups.push_back(bolts(mesh));
  ASSERT_EQ(mesh.groups.back().nodes.size(), 6u);
  scene.supports.push_back({.group = "bolts", .components = {0, 1, 2, 3, 4, 5}});
  expect_same(scene, mesh, 6000.0, Shapes::left_out);
}

/// A mesh file may have digits that suffice for itself and not for what is made of it.
TEST(SectorFrequencies, AreTheWholeBodysWhereARefinedMeshDoesNotRepeat)
{
  const scene::Scene scene = held(annulus(0.03));
  mesh::Mesh mesh = mesh_on_all_ranks(scene);
  for (auto& x : mesh.positions)
    for (double& value : x) value = std::round(value * 1e7) / 1e7;
  MeshFrequencies frequencies(scene, mesh);
  const MeshErrors ours = frequencies.errors_up_to(two_pi * 5000.0, {});
  mesh.positions[40][2] += 1e-6;  // which does not repeat
  MeshFrequencies of_whole(scene, mesh);
  const MeshErrors theirs = of_whole.errors_up_to(two_pi * 5000.0, {});
  ASSERT_EQ(ours.omega.size(), theirs.omega.size());
  EXPECT_LT((ours.errors - theirs.errors).cwiseAbs().maxCoeff(), 0.03 * theirs.largest());
}

/// The mesh of a file or generator may be that of one sector.
TEST(SectorFrequencies, OfAMeshOfOneSectorAreThoseOfTheWhole)
{
  const auto expect_those_of = [](const scene::Scene& scene, const mesh::Mesh& whole) {
    const mesh::Mesh one = mesh::one_sector(whole, mesh::n_repetitions(whole));
    const auto ours = SectorFrequencies::find(scene, one),
               theirs = SectorFrequencies::find(scene, whole);
    ASSERT_TRUE(ours && theirs);
    EXPECT_EQ(ours->n_dofs(), theirs->n_dofs());
    const MeshErrors of_one = ours->errors_up_to(two_pi * 6000.0, {}).value(),
                     of_whole = theirs->errors_up_to(two_pi * 6000.0, {}).value();
    ASSERT_EQ(of_one.omega.size(), of_whole.omega.size());
    EXPECT_LT((of_one.omega - of_whole.omega).cwiseQuotient(of_whole.omega).cwiseAbs().maxCoeff(),
              1e-8);
    EXPECT_LT((of_one.errors - of_whole.errors).cwiseAbs().maxCoeff(), 1e-6 * of_whole.largest());
  };
  const scene::Scene scene = held(annulus(0.03));
  expect_those_of(scene, mesh_on_all_ranks(scene));
  expect_those_of(scene, twisted(mesh_on_all_ranks(scene)));
  // Large elements are cut at free edges, which the edges of the sector are not.
  const scene::Scene large = held(annulus(0.08));
  expect_those_of(large, mesh_on_all_ranks(large));
}

/// A disc of three sectors with slots that leave the end of each rim hanging on the next sector.
mesh::Mesh slotted(mesh::Mesh mesh)
{
  for (mesh::ElementBlock& block : mesh.blocks) {
    mesh::ElementBlock kept = block;
    kept.numbers.clear(), kept.nodes.clear(), kept.group.clear();
    for (int e = 0; e < block.n_elements(); ++e) {
      double x = 0.0, y = 0.0;
      for (const int node : block.element_nodes(e)) {
        x += mesh.positions[std::size_t(node)][0] / block.nodes_per_element;
        y += mesh.positions[std::size_t(node)][1] / block.nodes_per_element;
      }
      const double radius = std::hypot(x, y), turn = std::atan2(y, x) / two_pi + 1.0;
      const double degrees = 360.0 * std::fmod(turn, 1.0 / 3.0);
      const bool is_slot = degrees > 60.0 && radius > 0.08 && (radius < 0.11 || degrees < 90.0);
      if (is_slot) continue;
      kept.numbers.push_back(block.numbers[std::size_t(e)]);
      kept.group.push_back(block.group[std::size_t(e)]);
      for (const int node : block.element_nodes(e)) kept.nodes.push_back(node);
    }
    block = kept;
  }
  mesh::drop_unused_nodes(mesh);
  return mesh;
}

TEST(SectorFrequencies, OfPiecesThatHangTogetherThroughOtherSectorsAreThoseOfTheWhole)
{
  for (const bool is_held : {false, true}) {
    const scene::Scene scene = is_held ? held(annulus(0.02)) : annulus(0.02);
    const mesh::Mesh whole = slotted(mesh_on_all_ranks(scene));
    const mesh::Mesh one = mesh::one_sector(whole, 3);
    const auto sector = SectorFrequencies::find(scene, one);
    ASSERT_TRUE(sector.has_value());
    const SupportedModel model = assemble_supported(scene, whole);
    ASSERT_EQ(model.free.size(), is_held ? 0U : 1U);
    EXPECT_EQ(sector->n_dofs(), model.system.dofs.n_dofs());
    const VectorXd ours = sector->up_to(two_pi * 2000.0, {});
    const int n_rigid = plate::n_free_motions(model.free);
    const reduce::NaturalModes modes = reduce::natural_modes(
        model.system.K, model.system.M, reduce::free_dofs(model.system.K, model.held),
        {.n_modes = n_rigid + int(ours.size()), .n_rigid = n_rigid});
    ASSERT_GT(ours.size(), 5);
    for (Eigen::Index i = 0; i < ours.size(); ++i)
      EXPECT_NEAR(std::sqrt(modes.lambda[std::size_t(n_rigid + i)]) / ours[i], 1.0, 1e-8);
  }
}

/// What each sector holds by itself holds the body, also where it would let a sector turn.
TEST(SectorFrequencies, OfASupportThatHoldsTheBodyButNoSectorAreThoseOfTheWhole)
{
  scene::Scene scene = annulus(0.03);
  mesh::Mesh whole = mesh_on_all_ranks(scene);
  whole.groups.push_back(bolts(whole));
  scene.supports = {{.group = "bolts", .components = {0, 1, 2}}};
  const mesh::Mesh one = mesh::one_sector(whole, 3);
  const auto sector = SectorFrequencies::find(scene, one);
  ASSERT_TRUE(sector.has_value());
  EXPECT_GT(sector->up_to(two_pi * 3000.0, {})[0], two_pi * 10.0);
}

TEST(SectorFrequencies, OfAMeshOfOneSectorAreRefusedWhereTheSupportDoesNotTurn)
{
  const scene::Scene scene = held(annulus(0.03), {0, 1});
  const mesh::Mesh whole = mesh_on_all_ranks(scene);
  const mesh::Mesh one = mesh::one_sector(whole, mesh::n_repetitions(whole));
  EXPECT_THROW(SectorFrequencies::find(scene, one), Error);
}

TEST(Split, OfOneSectorKeepsItsCutEdges)
{
  const scene::Scene scene = annulus(0.03);
  const mesh::Mesh whole = mesh_on_all_ranks(scene);
  const mesh::Mesh one = mesh::one_sector(whole, mesh::n_repetitions(whole));
  const mesh::Mesh finer = split(one, {.order = 3, .halvings = 1});
  EXPECT_EQ(finer.sectors.count, one.sectors.count);
  // 3 intervals for 2, of twice as many elements.
  EXPECT_EQ(finer.sectors.pairs.size(), 3 * (one.sectors.pairs.size() - 1) + 1);
  EXPECT_EQ(finer.blocks.front().order, 3);
  EXPECT_EQ(finer.blocks.front().n_elements(), 4 * one.blocks.front().n_elements());
}

TEST(SectorFrequencies, AreNotThoseOfASupportThatDoesNotTurn)
{
  const auto finds = [](const scene::Scene& scene) {
    return SectorFrequencies::find(scene, mesh_on_all_ranks(scene)).has_value();
  };
  EXPECT_TRUE(finds(held(annulus(0.03))));
  EXPECT_FALSE(finds(held(annulus(0.03), {0, 1})));  // which leaves some rigid-body motions
  scene::Scene in_x = held(annulus(0.03));
  in_x.supports.push_back({.group = "track", .components = {0}});
  EXPECT_FALSE(finds(in_x));
  in_x.supports.back().components = {0, 1};
  EXPECT_TRUE(finds(in_x));
}

}  // namespace
}  // namespace chladni::cases
