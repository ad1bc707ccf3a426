#include "plate/dofs/point_elements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "plate/dofs/drilling.hpp"

namespace chladni::plate {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

std::vector<int> nodes_at(const mesh::Mesh& mesh, const DofMap& dofs, const std::string& what,
                          const std::string& name)
{
  std::vector<int> nodes = dofs.named_nodes(mesh, name);
  if (!nodes.empty()) return nodes;
  throw Error(
      fmt::format("{} \"{}\": no element of the mesh has a node of this group; its motion "
                  "would be undetermined",
                  what, name));
}

bool any(const std::array<double, 6>& values)
{
  return std::ranges::any_of(values, [](double value) { return value != 0.0; });
}

int only_node(const mesh::Mesh& mesh, const DofMap& dofs, const std::string& name)
{
  const std::vector<int> nodes = nodes_at(mesh, dofs, "spring at", name);
  if (nodes.size() == 1) return nodes.front();
  throw Error(
      fmt::format("spring at \"{}\": between two places each must be one node, and this "
                  "group has {}; name a point, or couple the group",
                  name, nodes.size()));
}

/// K and C of one spring by the matrix of its constants.
template <typename MatrixOf>
PointElement spring_element(std::vector<int> nodes, const Spring& spring, const MatrixOf& matrix_of)
{
  PointElement element{
      .nodes = std::move(nodes), .K = {}, .M = {}, .C = {}, .loss_factor = spring.loss_factor};
  if (any(spring.stiffness)) element.K = matrix_of(spring.stiffness);
  if (any(spring.damping)) element.C = matrix_of(spring.damping);
  return element;
}

/// The two nodes of a spring between places.
std::vector<int> nodes_between(const mesh::Mesh& mesh, const DofMap& dofs, const Spring& spring)
{
  const int a = only_node(mesh, dofs, spring.at);
  const int b = only_node(mesh, dofs, *spring.to);
  if (a == b)
    throw Error(fmt::format("spring at \"{}\": leads to the node where it begins", spring.at));
  return {a, b};
}

/// Nodes of solids have no rotations that inertia, an offset, springs or forces beside the line
/// between two nodes could act on.
/// @param what  `mass at "pin"`
void refuse_moments(const mesh::Mesh& mesh, const DofMap& dofs, const PointElement& element,
                    const std::string& what)
{
  constexpr double round_off = 1e-12;
  for (std::size_t i = 0; i < element.nodes.size(); ++i) {
    if (dofs.has_rotations(element.nodes[i])) continue;
    for (const MatrixXd* A : {&element.K, &element.M, &element.C}) {
      if (A->size() == 0) continue;
      const double of_rotations = A->middleRows<3>(6 * Eigen::Index(i) + 3).cwiseAbs().maxCoeff();
      if (of_rotations <= round_off * A->cwiseAbs().maxCoeff()) continue;
      throw Error(fmt::format(
          "{}: node {} of a solid has no rotations, so that no moment (of inertia, an offset, a "
          "rotational spring, or a force beside the line between two nodes) can act there; take it "
          "out, or couple a group of nodes rigidly ([[coupling]]) and take the coupling's name",
          what, mesh.node_numbers[element.nodes[i]]));
    }
  }
}

PointElement spring_between(const mesh::Mesh& mesh, const DofMap& dofs, const Spring& spring)
{
  const std::vector<int> nodes = nodes_between(mesh, dofs, spring);
  const Vector3d ab = dofs.position(nodes[1]) - dofs.position(nodes[0]);
  return spring_element(nodes, spring, [&](const std::array<double, 6>& k) -> MatrixXd {
    return spring_matrix(k, ab);
  });
}

/// A component of a node of equations alone is at rest if none of them has it.
void refuse_at_rest(const mesh::Mesh& mesh, const DofMap& dofs, const Spring& spring,
                    std::span<const int> nodes)
{
  if (mesh.equations.empty()) return;
  const auto alone = nodes_of_equations_alone(mesh, dofs.coupled());
  for (const int node : nodes) {
    const auto found = alone.find(node);
    if (found == alone.end()) continue;
    for (std::size_t c = 0; c < 6; ++c) {
      if ((spring.stiffness[c] == 0.0 && spring.damping[c] == 0.0) ||
          found->second.contains(int(c)))
        continue;
      throw Error(fmt::format(
          "spring at \"{}\": node {} belongs to no element, and no equation has its {}, along "
          "which "
          "the spring acts; give the node an equation there, or take that stiffness out",
          spring.at, mesh.node_numbers[std::size_t(node)], component_names[c]));
    }
  }
}

}  // namespace

std::vector<PlacedSpring> place_springs(const mesh::Mesh& mesh, const DofMap& dofs,
                                        std::span<const Spring> springs)
{
  std::vector<PlacedSpring> placed;
  for (const Spring& spring : springs) {
    refuse_at_rest(mesh, dofs, spring,
                   spring.to ? nodes_between(mesh, dofs, spring)
                             : nodes_at(mesh, dofs, "spring at", spring.at));
    std::vector<int> components;
    for (int c = 0; c < 6; ++c)
      if (spring.stiffness[static_cast<std::size_t>(c)] != 0.0) components.push_back(c);
    if (components.empty()) continue;
    if (spring.to) {
      placed.push_back({nodes_between(mesh, dofs, spring), components});
      continue;
    }
    for (const int node : nodes_at(mesh, dofs, "spring at", spring.at))
      placed.push_back({{node}, components});
  }
  return placed;
}

Matrix6d point_mass_matrix(const PointMass& mass)
{
  const auto [xx, yy, zz, xy, xz, yz] = mass.inertia;
  const Matrix3d c = cross_matrix(Vector3d(mass.offset.data()));
  Matrix3d J;
  J << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  Matrix6d M;
  M << mass.mass * Matrix3d::Identity(), -mass.mass * c, mass.mass * c, J - mass.mass * c * c;
  return M;
}

Eigen::Matrix<double, 12, 12> spring_matrix(const std::array<double, 6>& k, const Vector3d& ab)
{
  // At the middle p: u_a + theta_a x ab / 2 and u_b - theta_b x ab / 2.
  const Matrix3d I = Matrix3d::Identity();
  const Matrix3d arm = 0.5 * cross_matrix(ab);
  Eigen::Matrix<double, 6, 12> B = Eigen::Matrix<double, 6, 12>::Zero();
  B.topRows<3>() << -I, arm, I, arm;
  B.block<3, 3>(3, 3) = -I;
  B.block<3, 3>(3, 9) = I;
  return B.transpose() * Eigen::Map<const Eigen::Vector<double, 6>>(k.data()).asDiagonal() * B;
}

std::vector<PointElement> point_elements(const mesh::Mesh& mesh, const Structure& structure,
                                         const DofMap& dofs)
{
  refuse_drilling(mesh, dofs, structure);
  std::vector<PointElement> elements;
  const auto add = [&](PointElement element, const char* what, const std::string& at) {
    refuse_moments(mesh, dofs, element, fmt::format("{} at \"{}\"", what, at));
    elements.push_back(std::move(element));
  };
  for (const PointMass& mass : structure.masses)
    for (const int node : nodes_at(mesh, dofs, "mass at", mass.at))
      add({.nodes = {node}, .K = {}, .M = point_mass_matrix(mass), .C = {}}, "mass", mass.at);
  for (const Spring& spring : structure.springs) {
    if (spring.to) {
      add(spring_between(mesh, dofs, spring), "spring", spring.at);
      continue;
    }
    for (const int node : nodes_at(mesh, dofs, "spring at", spring.at)) {
      add(spring_element({node}, spring,
                         [](const std::array<double, 6>& k) -> MatrixXd {
                           return Eigen::Map<const Eigen::Vector<double, 6>>(k.data()).asDiagonal();
                         }),
          "spring", spring.at);
    }
  }
  return elements;
}

}  // namespace chladni::plate
