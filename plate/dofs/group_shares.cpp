#include "plate/dofs/group_shares.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "mesh/element_parts.hpp"
#include "plate/elements/interpolation.hpp"
#include "plate/sections/directors.hpp"

namespace chladni::plate {

namespace {

/// int N_i ds along one edge.
Eigen::VectorXd shares_of_edge(const mesh::Mesh& mesh, const std::vector<int>& edge)
{
  const auto p = static_cast<int>(edge.size()) - 1;
  const GaussRule gauss = gauss_legendre(p + 2);
  const Eigen::VectorXd ends = Eigen::VectorXd::LinSpaced(2, -1.0, 1.0);
  const Points points =
      tensor_points(gauss.x, ends.head(1));  // the lower edge of the parent square
  const Basis basis = lagrange_basis(mesh::Shape::quadrilateral, p, points);
  Eigen::MatrixX3d x(p + 1, 3);
  for (int i = 0; i <= p; ++i) x.row(i) = Eigen::RowVector3d(mesh.positions[edge[i]].data());
  const Eigen::MatrixX3d tangents = basis.N_xi.leftCols(p + 1) * x;
  const Eigen::VectorXd lengths = gauss.w.cwiseProduct(tangents.rowwise().norm());
  return basis.N.leftCols(p + 1).transpose() * lengths;
}

/// int N_i dA of one element.
Eigen::VectorXd shares_of_element(const mesh::Mesh& mesh, const mesh::ElementBlock& block,
                                  int element)
{
  const Points points = gauss_points(block.shape, block.order + 2);
  const Basis basis = lagrange_basis(block.shape, block.order, points);
  const NodeVectors x = element_positions(mesh, block, element);
  const NodeVectors a_1 = basis.N_xi * x;
  const NodeVectors a_2 = basis.N_eta * x;
  Eigen::VectorXd areas(points.size());
  for (Eigen::Index q = 0; q < points.size(); ++q)
    areas[q] = points.weight[q] * a_1.row(q).cross(a_2.row(q)).norm();
  return basis.N.transpose() * areas;
}

std::map<int, double> surface_shares(const mesh::Mesh& mesh, const mesh::Group& group)
{
  const auto index = static_cast<int>(&group - mesh.groups.data());
  std::map<int, double> shares;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (block.shape == mesh::Shape::line) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      if (block.group[e] != index) continue;
      const Eigen::VectorXd of_element = shares_of_element(mesh, block, e);
      for (Eigen::Index i = 0; i < of_element.size(); ++i)
        shares[block.element_nodes(e)[i]] += of_element[i];
    }
  }
  return shares;
}

}  // namespace

std::map<int, double> edge_shares(const mesh::Mesh& mesh, const std::string& group)
{
  std::map<int, double> shares;
  for (const std::vector<int>& edge : mesh::edges_in(mesh, mesh::find_group(mesh, group))) {
    const Eigen::VectorXd of_edge = shares_of_edge(mesh, edge);
    for (std::size_t i = 0; i < edge.size(); ++i)
      shares[edge[i]] += of_edge[static_cast<Eigen::Index>(i)];
  }
  return shares;
}

std::map<int, double> group_shares(const mesh::Mesh& mesh, const std::string& name)
{
  const mesh::Group& group = mesh::find_group(mesh, name);
  std::map<int, double> shares =
      group.dimension == 2 ? surface_shares(mesh, group) : edge_shares(mesh, name);
  const auto has_share = [&](int node) { return shares.contains(node); };
  if (std::ranges::all_of(group.nodes, has_share)) return shares;
  shares.clear();  // nodes without the edges between them
  for (const int node : group.nodes) shares[node] = 1.0;
  return shares;
}

}  // namespace chladni::plate
