// Ribs: lines whose nodes are those of shells of the same order.
#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "plate/elements/beam_element.hpp"
#include "plate/sections/sections.hpp"
#include "shell_model.hpp"

namespace chladni::plate::testing {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

const Material rib_steel{.young = 2e11, .poisson = 0.3, .density = 8000.0};

/// 20 mm wide and 100 mm high, and so stiff in shear that it does not shear the plate beside it:
/// that would be a layer as thin as the plate, which no order resolves.
const BeamSection rib{.group = "rib",
                      .material = rib_steel,
                      .area = 2e-3,
                      .I_y = 1e-3 * 2e-3 / 1.2,
                      .I_z = 1e-3 * 8e-5 / 1.2,
                      .J = 2.5e-7,
                      .shear_factor_y = 100.0,
                      .shear_factor_z = 100.0,
                      .orientation = std::array{0.0, 0.0, 1.0}};

/// The nodes of the lines of the elements' order along the middle of the square, v = 1/2.
std::vector<std::vector<int>> middle_lines(const ShellModel& model, int order)
{
  std::vector<int> nodes;
  for (int node = 0; node < model.mesh.n_nodes(); ++node)
    if (std::abs(model.uv[node][1] - 0.5) < 1e-9) nodes.push_back(node);
  std::ranges::sort(nodes, {}, [&](int node) { return model.uv[node][0]; });
  std::vector<std::vector<int>> lines;
  for (std::size_t first = 0; first + 1 < nodes.size(); first += order)
    lines.emplace_back(nodes.begin() + first, nodes.begin() + first + order + 1);
  return lines;
}

void add_line(ShellModel& model, const std::vector<int>& nodes)
{
  NodeVectors x(std::ssize(nodes), 3);
  for (Index i = 0; i < x.rows(); ++i) x.row(i) = model.position(nodes[i]).transpose();
  const ElementMatrices line =
      beam_matrices(x, rib, line_fields(nodes_on_surfaces(model.mesh), nodes));
  for (Index j = 0; j < line.K.cols(); ++j) {
    for (Index i = 0; i < line.K.rows(); ++i) {
      const Index row = 6 * nodes[i / 6] + i % 6, column = 6 * nodes[j / 6] + j % 6;
      model.K.coeffRef(row, column) += line.K(i, j);
      model.M.coeffRef(row, column) += line.M(i, j);
    }
  }
}

/// Bending of a simply supported plate, 1 m by 1 m and 20 mm thick, with a rib in the middle, Hz.
VectorXd ribbed_plate(int order, int n)
{
  ShellModel model = shell_model(
      {[](double u, double v) -> Vector3d {
        return {u, v, 0.0};
      }},
      {.shape = mesh::Shape::quadrilateral, .order = order, .n_u = n, .n_v = n}, rib_steel, 0.02);
  for (const std::vector<int>& nodes : middle_lines(model, order)) add_line(model, nodes);
  const auto everywhere = [](const Vector2d& /*uv*/) { return true; };
  // Held in z, and the turn along each edge.
  return frequencies(model,
                     free_dofs(model, {{everywhere, {0, 1, 5}},
                                       {on_boundary, {2}},
                                       {on(0, 0.0), {3}},
                                       {on(0, 1.0), {3}},
                                       {on(1, 0.0), {4}},
                                       {on(1, 1.0), {4}}}),
                     4);
}

TEST(Rib, MakesAPlateConvergeWithTheOrderOfItsElements)
{
  const VectorXd reference = ribbed_plate(4, 8);
  const auto errors = [&](int order, int n) -> VectorXd {
    return (ribbed_plate(order, n).array() / reference.array() - 1.0).abs();
  };
  const VectorXd coarse = errors(2, 4), fine = errors(2, 8), cubic = errors(3, 8);
  for (Index mode = 0; mode < 4; ++mode) {
    EXPECT_GT(std::log2(coarse[mode] / fine[mode]), 3.5) << mode;
    EXPECT_LT(cubic[mode], 1e-5) << mode;
  }
}

TEST(Rib, HasTheFieldsOfTheSurfaceWhereItSharesInnerNodes)
{
  const std::vector<char> on_surface{1, 1, 1, 0};
  EXPECT_EQ(line_fields(on_surface, std::vector{0, 1, 2}), LineFields::isoparametric);
  EXPECT_EQ(line_fields(on_surface, std::vector{0, 3, 2}), LineFields::best);
  EXPECT_EQ(line_fields(on_surface, std::vector{0, 2}), LineFields::best);
}

}  // namespace
}  // namespace chladni::plate::testing
