#include "plate/sections/directors.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "plate/sections/profile.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::RowVector3d;

const double smooth_cosine = std::cos(20.0 * std::numbers::pi / 180.0);

Basis nodal_basis(const mesh::ElementBlock& block)
{
  const int p = block.order;
  if (block.shape == mesh::Shape::quadrilateral) {
    const Eigen::VectorXd lattice = Eigen::VectorXd::LinSpaced(p + 1, -1.0, 1.0);
    return lagrange_basis(block.shape, p, tensor_points(lattice, lattice));
  }
  Points points{.xi = Eigen::VectorXd(block.nodes_per_element),
                .eta = Eigen::VectorXd(block.nodes_per_element),
                .weight = Eigen::VectorXd::Ones(block.nodes_per_element)};
  for (int j = 0, k = 0; j <= p; ++j) {
    for (int i = 0; i <= p - j; ++i, ++k) {
      points.xi[k] = double(i) / p;
      points.eta[k] = double(j) / p;
    }
  }
  return lagrange_basis(block.shape, p, points);
}

/// Unit normals at the nodes of one element.
NodeVectors element_normals(const Basis& at_nodes, const NodeVectors& x)
{
  const NodeVectors a_1 = at_nodes.N_xi * x;
  const NodeVectors a_2 = at_nodes.N_eta * x;
  NodeVectors normals(x.rows(), 3);
  for (Index i = 0; i < x.rows(); ++i) normals.row(i) = a_1.row(i).cross(a_2.row(i)).normalized();
  return normals;
}

/// A normal that vanishes or turns over inside an element is the end of any result.
void check_normals(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                   const NodeVectors& normals)
{
  for (Index i = 0; i < normals.rows(); ++i) {
    if (normals.row(i).dot(normals.row(0)) > 0.0) continue;
    throw Error(fmt::format(
        "element {} is degenerate or folded over at its node {} (its Jacobian is not positive); "
        "repair or refine the mesh there",
        block.numbers[element], mesh.node_numbers[block.element_nodes(element)[i]]));
  }
}

/// Nodes of the cut edges of a sector have the elements of both its neighbours around them.
void add_over_sector_edges(const mesh::Mesh& mesh, NodeVectors& sum)
{
  const double angle = 2.0 * std::numbers::pi / mesh.sectors.count;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix();
  for (const auto& [low, high] : mesh.sectors.pairs) {
    const RowVector3d at_low = sum.row(low), from_high = sum.row(high) * turn;
    const RowVector3d both = at_low + (at_low.dot(from_high) < 0.0 ? -1.0 : 1.0) * from_high;
    sum.row(low) = both;
    sum.row(high) = both * turn.transpose();
  }
}

}  // namespace

NodeVectors element_positions(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element)
{
  NodeVectors x(block.nodes_per_element, 3);
  for (Index i = 0; i < x.rows(); ++i) {
    const auto& p = mesh.positions[block.element_nodes(element)[i]];
    x.row(i) << p[0], p[1], p[2];
  }
  return x;
}

namespace {

/// Both nodes of a pair on the cut edges of a sector, where one is wanted.
NodeMask with_partners(const mesh::Mesh& mesh, NodeMask wanted)
{
  if (wanted.empty()) return NodeMask(std::size_t(mesh.n_nodes()), 1);
  for (const auto& [low, high] : mesh.sectors.pairs)
    if (wanted[low] != 0 || wanted[high] != 0) wanted[low] = wanted[high] = 1;
  return wanted;
}

/// Calls visit(node, its normal in the element) for the nodes that are wanted, after
/// check(block, element, normals).
template <typename Check, typename Visit>
void for_normals(const mesh::Mesh& mesh, const NodeMask& wanted, const Check& check,
                 const Visit& visit)
{
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (block.shape == mesh::Shape::line) continue;
    const Basis at_nodes = nodal_basis(block);
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto nodes = block.element_nodes(e);
      if (std::ranges::none_of(nodes, [&](int node) { return wanted[node] != 0; })) continue;
      const NodeVectors normals = element_normals(at_nodes, element_positions(mesh, block, e));
      check(block, e, normals);
      for (Index i = 0; i < normals.rows(); ++i)
        if (wanted[nodes[i]] != 0) visit(nodes[i], normals.row(i));
    }
  }
}

}  // namespace

NodeVectors mean_normals(const mesh::Mesh& mesh, NodeMask wanted)
{
  NodeVectors sum = NodeVectors::Zero(mesh.n_nodes(), 3);
  const auto check = [&](const mesh::ElementBlock& block, int e, const NodeVectors& normals) {
    check_normals(mesh, block, e, normals);
  };
  for_normals(mesh, with_partners(mesh, std::move(wanted)), check,
              [&](int node, const RowVector3d& normal) {
                auto node_sum = sum.row(node);
                const double side = node_sum.dot(normal) < 0.0 ? -1.0 : 1.0;
                node_sum += side * normal;
              });
  add_over_sector_edges(mesh, sum);
  sum.rowwise().normalize();
  return sum;
}

NodeVectors smooth_normals(const mesh::Mesh& mesh, NodeMask wanted)
{
  const NodeVectors mean = mean_normals(mesh, wanted);
  NodeVectors smooth = mean;
  if (wanted.empty()) wanted.assign(std::size_t(mesh.n_nodes()), 1);
  const auto is_checked = [](const auto&...) {};
  for_normals(mesh, wanted, is_checked, [&](int node, const RowVector3d& normal) {
    if (!(std::abs(mean.row(node).dot(normal)) > smooth_cosine)) smooth.row(node).setZero();
  });
  return smooth;
}

ShellNodes shell_nodes(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const NodeVectors& normals, const ShellSection& section)
{
  NodeVectors x = element_positions(mesh, block, element);
  NodeVectors D = element_normals(nodal_basis(block), x);
  for (Index i = 0; i < D.rows(); ++i) {
    const int node = block.element_nodes(element)[i];
    const RowVector3d mean = normals.row(node);
    const double cosine = mean.dot(D.row(i));
    if (std::abs(cosine) > smooth_cosine) D.row(i) = cosine < 0.0 ? RowVector3d(-mean) : mean;
    x.row(i) += value_at(section.offset, mesh.positions[node]) * D.row(i);
    D.row(i) *= 0.5 * value_at(section.thickness, mesh.positions[node]);
  }
  return {.x = x, .D = D};
}

}  // namespace chladni::plate
