#include "plate/refinement/refined_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "mesh/element_types.hpp"
#include "mesh/extrude.hpp"
#include "mesh/generators.hpp"
#include "plate/elements/solid_element.hpp"

namespace chladni::plate {
namespace {

mesh::Mesh disc(mesh::Pattern pattern, int order)
{
  return mesh::annulus({.inner_radius = 0.1,
                        .outer_radius = 0.2,
                        .element_size = 0.05,
                        .element_order = order,
                        .rings = {{.name = "track", .radius = 0.15, .nodes = 12}},
                        .pattern = pattern});
}

/// The largest distance of a group's nodes from a circle about the axis, m.
double off_circle(const mesh::Mesh& mesh, const std::string& group, double radius)
{
  double largest = 0.0;
  for (const int node : mesh::find_group(mesh, group).nodes) {
    const auto& x = mesh.positions[static_cast<std::size_t>(node)];
    largest = std::max(largest, std::abs(std::hypot(x[0], x[1]) - radius));
  }
  return largest;
}

/// Of all nodes: 1, x, y and their products up to third order, as displacements.
Eigen::MatrixXd cubics(const mesh::Mesh& mesh)
{
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(6 * mesh.n_nodes(), 10);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const auto& x = mesh.positions[static_cast<std::size_t>(node)];
    int column = 0;
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; i + j <= 3; ++j)
        motions(6 * node + 2, column++) = std::pow(x[0], i) * std::pow(x[1], j);
  }
  return motions;
}

TEST(RefinedMesh, KeepsCirclesAndGroups)
{
  for (const auto pattern : {mesh::Pattern::structured, mesh::Pattern::triangles}) {
    const mesh::Mesh coarse = disc(pattern, 3);
    const RefinedMesh fine = refined(coarse, {.parts = 2, .order = 3});
    EXPECT_LT(off_circle(fine.mesh, "outer_edge", 0.2), 1e-12);
    EXPECT_LT(off_circle(fine.mesh, "inner_edge", 0.1), 1e-12);
    EXPECT_EQ(mesh::find_group(fine.mesh, "outer_edge").nodes.size(),
              2 * mesh::find_group(coarse, "outer_edge").nodes.size());
    EXPECT_EQ(mesh::find_group(fine.mesh, "track").nodes.size(), 12U);
    EXPECT_EQ(mesh::find_group(fine.mesh, "disc").nodes.size(), fine.mesh.positions.size());
    EXPECT_TRUE(keeps_points(coarse, fine.mesh));
    EXPECT_EQ(fine.mesh.blocks.front().n_elements(), 4 * coarse.blocks.front().n_elements());
  }
}

/// On straight elements interpolation of order 3 loses nothing of cubics.
TEST(RefinedMesh, InterpolatesWhatItsElementsHold)
{
  for (const auto pattern : {mesh::Pattern::structured, mesh::Pattern::triangles}) {
    const mesh::Mesh coarse = mesh::rectangle(
        {.length = 1.0, .width = 1.0, .element_size = 0.4, .element_order = 3, .pattern = pattern});
    const std::vector<double> rows(coarse.positions.size(), 0.02);
    for (const Refinement& how :
         {Refinement{.parts = 1, .order = 2}, Refinement{.parts = 2, .order = 3},
          Refinement{.parts = 2, .order = 3, .edge_rows = rows}}) {
      const RefinedMesh fine = refined(coarse, how);
      const Eigen::MatrixXd found = interpolated(coarse, fine, cubics(coarse));
      EXPECT_LT((found - cubics(fine.mesh)).cwiseAbs().maxCoeff(), 1e-13);
    }
  }
}

/// Elements along the edges are cut at the width of the row, so that nodes stand there.
TEST(RefinedMesh, CutsElementsAtFreeEdges)
{
  constexpr double row = 0.02;
  for (const auto pattern : {mesh::Pattern::structured, mesh::Pattern::triangles}) {
    const mesh::Mesh coarse = mesh::rectangle({.length = 1.0,
                                               .width = 1.0,
                                               .element_size = 0.25,
                                               .element_order = 1,
                                               .pattern = pattern});
    const std::vector<double> rows(coarse.positions.size(), row);
    EXPECT_TRUE(has_wide_edges(coarse, rows));
    const RefinedMesh fine = refined(coarse, {.parts = 2, .order = 1, .edge_rows = rows});
    double nearest = 1.0;
    for (const auto& x : fine.mesh.positions)
      if (x[1] > 1e-12) nearest = std::min(nearest, x[1]);
    EXPECT_LE(nearest, row * (1.0 + 1e-12));
    EXPECT_GT(nearest, 0.5 * row);
    const std::vector<double> wide(coarse.positions.size(), 0.2);
    EXPECT_FALSE(has_wide_edges(coarse, wide));
  }
}

TEST(RefinedMesh, KeepsLinesOnTheCircleOfTheirNodes)
{
  mesh::ElementBlock block{.shape = mesh::Shape::line,
                           .order = 2,
                           .nodes_per_element = 3,
                           .numbers = {1, 2, 3, 4},
                           .nodes = {0, 1, 2, 2, 3, 4, 4, 5, 6, 6, 7, 0},
                           .group = {0, 0, 0, 0}};
  mesh::Mesh ring{.node_numbers = {1, 2, 3, 4, 5, 6, 7, 8},
                  .positions = {},
                  .blocks = {block},
                  .groups = {{.name = "rim", .dimension = 1, .nodes = {0, 1, 2, 3, 4, 5, 6, 7}}},
                  .notes = {}};
  for (int i = 0; i < 8; ++i) {
    ring.positions.push_back({0.2 * std::cos(0.25 * std::numbers::pi * i),
                              0.2 * std::sin(0.25 * std::numbers::pi * i), 0.0});
  }
  for (const Refinement& how : {Refinement{.parts = 2, .order = 2}, Refinement{.order = 4}}) {
    const RefinedMesh fine = refined(ring, how);
    EXPECT_EQ(fine.mesh.n_nodes(), 16);
    EXPECT_LT(off_circle(fine.mesh, "rim", 0.2), 1e-12);
  }
  EXPECT_TRUE(can_rise(ring));
}

TEST(RefinedMesh, KnowsWhichElementsHaveANextOrder)
{
  EXPECT_TRUE(can_rise(disc(mesh::Pattern::structured, 3)));
  EXPECT_FALSE(can_rise(disc(mesh::Pattern::structured, 4)));
  EXPECT_FALSE(can_rise(disc(mesh::Pattern::triangles, 3)));
  const RefinedMesh higher = refined(disc(mesh::Pattern::structured, 3), {.parts = 1, .order = 4});
  EXPECT_LT(off_circle(higher.mesh, "outer_edge", 0.2), 1e-12);
}

/// The unit cube as six tetrahedra of order 2 around a diagonal, with the group "base" of its face
/// z = 0.
mesh::Mesh tetrahedra()
{
  mesh::Mesh mesh;
  mesh.blocks.push_back({.shape = mesh::Shape::tetrahedron, .order = 2, .nodes_per_element = 10});
  mesh::ElementBlock& block = mesh.blocks.front();
  const auto node_at = [&](const mesh::Vector& x) {
    const auto found = std::ranges::find(mesh.positions, x);
    if (found != mesh.positions.end()) return static_cast<int>(found - mesh.positions.begin());
    mesh.node_numbers.push_back(mesh.n_nodes() + 1);
    mesh.positions.push_back(x);
    return mesh.n_nodes() - 1;
  };
  const std::array<mesh::Vector, 8> corners{{{0.0, 0.0, 0.0},
                                             {1.0, 0.0, 0.0},
                                             {1.0, 1.0, 0.0},
                                             {0.0, 1.0, 0.0},
                                             {0.0, 0.0, 1.0},
                                             {1.0, 0.0, 1.0},
                                             {1.0, 1.0, 1.0},
                                             {0.0, 1.0, 1.0}}};
  const std::array<std::size_t, 7> around{1, 2, 3, 7, 4, 5, 1};
  for (std::size_t k = 0; k < 6; ++k) {
    const std::array<mesh::Vector, 4> at{corners[0], corners[around[k]], corners[around[k + 1]],
                                         corners[6]};
    for (const auto& [r, s, t] : mesh::solid_nodes(mesh::Shape::tetrahedron, 2)) {
      mesh::Vector x{};
      for (std::size_t c = 0; c < 3; ++c)
        x[c] = (1.0 - r - s - t) * at[0][c] + r * at[1][c] + s * at[2][c] + t * at[3][c];
      block.nodes.push_back(node_at(x));
    }
    block.numbers.push_back(static_cast<std::int64_t>(k) + 1);
    block.group.push_back(-1);
  }
  mesh.groups.push_back({.name = "base", .dimension = 0, .nodes = {}});
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (mesh.positions[static_cast<std::size_t>(node)][2] == 0.0)
      mesh.groups.back().nodes.push_back(node);
  return mesh;
}

mesh::Mesh extruded_square(mesh::Pattern pattern, int order)
{
  const mesh::Mesh flat = mesh::rectangle({.length = 1.0,
                                           .width = 1.0,
                                           .element_size = 0.5,
                                           .element_order = order,
                                           .pattern = pattern});
  mesh::Mesh mesh = mesh::extruded(flat, {.from = 0.0, .to = 1.0}, {});
  for (mesh::Group& group : mesh.groups)
    if (group.name == "bottom_face") group.name = "base";
  return mesh;
}

/// The volume of the elements, none of which has a Jacobian that is not positive.
double volume(const mesh::Mesh& mesh)
{
  double sum = 0.0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      NodeVectors x(block.nodes_per_element, 3);
      for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const int node = block.element_nodes(e)[static_cast<std::size_t>(i)];
        x.row(i) = Eigen::RowVector3d(mesh.positions[static_cast<std::size_t>(node)].data());
      }
      const Eigen::VectorXd dV = solid_frame(block.shape, block.order, x).dV;
      EXPECT_GT(dV.minCoeff(), 0.0);
      sum += dV.sum();
    }
  }
  return sum;
}

/// x^i y^j z^k of a degree up to n at the nodes, as displacements along z.
Eigen::MatrixXd polynomials(const mesh::Mesh& mesh, int n)
{
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(6 * mesh.n_nodes(), (n + 1) * (n + 1) * (n + 1));
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const auto& x = mesh.positions[static_cast<std::size_t>(node)];
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        for (int k = 0; i + j + k <= n; ++k) {
          motions(6 * node + 2, (i * (n + 1) + j) * (n + 1) + k) =
              std::pow(x[0], i) * std::pow(x[1], j) * std::pow(x[2], k);
        }
  }
  return motions;
}

TEST(RefinedMesh, HoldsWhatSolidsHold)
{
  const std::vector<std::pair<mesh::Mesh, Refinement>> all{
      {tetrahedra(), {.parts = 2, .order = 2}},
      {extruded_square(mesh::Pattern::triangles, 2), {.parts = 2, .order = 2}},
      {extruded_square(mesh::Pattern::structured, 1), {.parts = 2, .order = 1}},
      {extruded_square(mesh::Pattern::structured, 2), {.parts = 2, .order = 2}},
      {extruded_square(mesh::Pattern::structured, 3), {.parts = 2, .order = 3}},
      {extruded_square(mesh::Pattern::structured, 1), {.parts = 1, .order = 2}},
      {extruded_square(mesh::Pattern::structured, 2), {.parts = 1, .order = 3}}};
  for (const auto& [coarse, how] : all) {
    const int order = coarse.blocks.front().order;
    const RefinedMesh fine = refined(coarse, how);
    SCOPED_TRACE(::testing::Message() << "shape " << int(coarse.blocks.front().shape) << ", order "
                                      << order << " to " << how.order);
    EXPECT_NEAR(volume(fine.mesh), 1.0, 1e-12);
    // Neighbours have their nodes in common: no other face is free.
    const std::size_t n_parts = how.parts == 2 ? 4 : 1;
    EXPECT_EQ(mesh::free_faces(fine.mesh).size(), n_parts * mesh::free_faces(coarse).size());
    std::set<std::vector<std::int64_t>> places;
    for (const auto& x : fine.mesh.positions)
      places.insert({std::lround(1e6 * x[0]), std::lround(1e6 * x[1]), std::lround(1e6 * x[2])});
    EXPECT_EQ(places.size(), fine.mesh.positions.size());
    const Eigen::MatrixXd found = interpolated(coarse, fine, polynomials(coarse, order));
    EXPECT_LT((found - polynomials(fine.mesh, order)).cwiseAbs().maxCoeff(), 1e-13);
    std::size_t n_base = 0;
    for (const auto& x : fine.mesh.positions) n_base += std::abs(x[2]) < 1e-12 ? 1 : 0;
    EXPECT_EQ(mesh::find_group(fine.mesh, "base").nodes.size(), n_base);
  }
}

}  // namespace
}  // namespace chladni::plate
