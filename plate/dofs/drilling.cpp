#include "plate/dofs/drilling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "common/error.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/free_motions.hpp"
#include "plate/dofs/point_elements.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

namespace {

using Eigen::MatrixX3d;
using Eigen::Vector3d;

constexpr double tilt = 1e-2;  // rad: normals of a mesh of a curved shell are as exact as that

/// Whether anything but a shell takes part in the motion of a node.
std::vector<bool> have_other_stiffness(const mesh::Mesh& mesh, const DofMap& dofs)
{
  std::vector<bool> have(dofs.n_nodes(), false), is_of_element(dofs.n_nodes(), false);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (const int node : block.nodes) is_of_element[node] = true;
    if (mesh::is_surface(block.shape)) continue;
    for (const int node : block.nodes) have[node] = true;
  }
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    if (dofs.is_dependent(node)) have[node] = true;
    // The end of a lever, which no element has, resists nothing.
    if (dofs.is_dependent(node) && is_of_element[node]) have[dofs.reference(node)] = true;
    if (node >= dofs.n_mesh_nodes() || !dofs.is_independent(node)) have[node] = true;
  }
  for (const HarmonicRing& ring : dofs.harmonic_rings())
    for (const int node : ring.nodes) have[node] = false;  // combined, but of shells alone
  return have;
}

/// The global rotation that is nearest to an axis.
const char* rotation_about(const Vector3d& axis)
{
  int nearest = 0;
  axis.cwiseAbs().maxCoeff(&nearest);
  return component_names[static_cast<std::size_t>(nearest) + 3];
}

/// `"corner": at node 17 nothing but ... resists the rotation rz about the normal (0, 0, 1)`
std::string where(const mesh::Mesh& mesh, const std::string& name, int node, const Vector3d& axis)
{
  const double side = axis.maxCoeff() >= -axis.minCoeff() ? 1.0 : -1.0;
  const Vector3d rounded = ((1e4 * side * axis).array().round() / 1e4 + 0.0).matrix();  // no -0
  return fmt::format(
      "\"{}\": node {} belongs to a smooth shell, whose elements resist the rotation {} about its "
      "normal ({:.4g}, {:.4g}, {:.4g}) by a numerical stiffness alone",
      name, mesh.node_numbers[node], rotation_about(axis), rounded[0], rounded[1], rounded[2]);
}

constexpr const char* couple_instead =
    "or couple a group of nodes rigidly ([[coupling]], type \"rigid\") and take the coupling's "
    "name";

/// The nodes of a name, or those that they follow, that have a drilling axis n with
/// is_wrong(n, arm) true: the first, or none. The arm leads from the node to the one that is named.
template <typename IsWrong>
std::optional<int> first_wrong(const mesh::Mesh& mesh, const DofMap& dofs, const std::string& name,
                               const MatrixX3d& axes, const IsWrong& is_wrong)
{
  for (const int named : dofs.named_nodes(mesh, name)) {
    const bool follows = dofs.is_dependent(named);
    const int node = follows ? dofs.reference(named) : named;
    const Vector3d n = axes.row(node), arm = follows ? dofs.arm(named) : Vector3d(0.0, 0.0, 0.0);
    if (!n.isZero() && is_wrong(n, arm)) return node;
  }
  return std::nullopt;
}

/// n^T A n is no small part of A, a matrix of rotations.
bool acts_about(const Vector3d& n, const Eigen::Matrix3d& A)
{
  return n.dot(A * n) > tilt * tilt * A.trace();
}

void refuse_mass(const mesh::Mesh& mesh, const DofMap& dofs, const MatrixX3d& axes,
                 const PointMass& mass)
{
  Eigen::Matrix3d J;  // about the node
  const auto node =
      first_wrong(mesh, dofs, mass.at, axes, [&](const Vector3d& n, const Vector3d& arm) {
        PointMass moved = mass;
        for (std::size_t c = 0; c < 3; ++c) moved.offset[c] += arm[Eigen::Index(c)];
        J = point_mass_matrix(moved).bottomRightCorner<3, 3>();
        return acts_about(n, J);
      });
  if (!node) return;
  const Vector3d n = axes.row(*node);
  throw Error(
      fmt::format("mass at {}, which {:.3g} kg m^2 of inertia would only swing against; take the "
                  "inertia about the normal out, an offset from it too, {}",
                  where(mesh, mass.at, *node, n), n.dot(J * n), couple_instead));
}

void refuse_spring(const mesh::Mesh& mesh, const DofMap& dofs, const MatrixX3d& axes,
                   const Spring& spring)
{
  const auto rotations = [](const std::array<double, 6>& k, const Vector3d& arm) {
    const Eigen::Matrix3d X = cross_matrix(arm);
    Eigen::Matrix3d A = X.transpose() * Vector3d(k[0], k[1], k[2]).asDiagonal() * X;
    A.diagonal() += Vector3d(k[3], k[4], k[5]);
    return A;
  };
  std::vector<std::string> ends{spring.at};
  if (spring.to) ends.push_back(*spring.to);
  for (const std::string& end : ends) {
    const auto node =
        first_wrong(mesh, dofs, end, axes, [&](const Vector3d& n, const Vector3d& arm) {
          return acts_about(n, rotations(spring.stiffness, arm)) ||
                 acts_about(n, rotations(spring.damping, arm));
        });
    if (!node) continue;
    throw Error(fmt::format(
        "spring at {}, so that a spring or damper about it holds nothing; take this component "
        "out, {}",
        where(mesh, end, *node, axes.row(*node)), couple_instead));
  }
}

/// Whether some of the held DOFs are such rotations, and which support is the first to hold one.
std::optional<std::pair<std::string, int>> first_drilling_support(const mesh::Mesh& mesh,
                                                                  const DofMap& dofs,
                                                                  const MatrixX3d& axes,
                                                                  std::span<const Support> supports)
{
  for (const Support& support : supports) {
    const auto node = first_wrong(
        mesh, dofs, support.group, axes, [&](const Vector3d& n, const Vector3d& /*arm*/) {
          return std::ranges::any_of(support.components,
                                     [&](int c) { return c >= 3 && std::abs(n[c - 3]) > tilt; });
        });
    if (node) return std::pair(support.group, *node);
  }
  return std::nullopt;
}

}  // namespace

MatrixX3d drilling_axes(const mesh::Mesh& mesh, const DofMap& dofs, std::span<const int> nodes)
{
  MatrixX3d axes = MatrixX3d::Zero(std::ssize(nodes), 3);
  if (mesh.matrices) return axes;  // nobody knows what resists it there
  NodeMask wanted(std::size_t(mesh.n_nodes()), 0);
  for (const int node : nodes)
    if (node < dofs.n_mesh_nodes()) wanted[std::size_t(node)] = 1;
  const NodeVectors normals = shell_directors(mesh, std::move(wanted)).common;
  const std::vector<bool> is_other = have_other_stiffness(mesh, dofs);
  for (Eigen::Index i = 0; i < axes.rows(); ++i) {
    const int node = nodes[std::size_t(i)];
    if (node >= dofs.n_mesh_nodes() || is_other[node]) continue;
    const Vector3d n = normals.row(node);
    int nearest = 0;
    n.cwiseAbs().maxCoeff(&nearest);
    if (!dofs.holds(3 + nearest)) axes.row(i) = n;
  }
  return axes;
}

MatrixX3d drilling_axes(const mesh::Mesh& mesh, const DofMap& dofs)
{
  std::vector<int> all(std::size_t(dofs.n_nodes()));
  std::iota(all.begin(), all.end(), 0);
  return drilling_axes(mesh, dofs, all);
}

void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, const Structure& structure)
{
  if (structure.masses.empty() && structure.springs.empty()) return;
  const MatrixX3d axes = drilling_axes(mesh, dofs);
  for (const PointMass& mass : structure.masses) refuse_mass(mesh, dofs, axes, mass);
  for (const Spring& spring : structure.springs) refuse_spring(mesh, dofs, axes, spring);
}

void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, std::span<const Load> loads)
{
  for (const Load& any_load : loads) {
    const auto* load = std::get_if<NodalLoad>(&any_load);
    if (!load) continue;
    const Vector3d moment(load->moment.data()), force(load->force.data());
    const std::vector<int> nodes = dofs.named_nodes(mesh, load->group);
    const bool has_lever =
        std::ranges::any_of(nodes, [&](int node) { return dofs.is_dependent(node); });
    if (moment.isZero(0.0) && !has_lever) continue;
    const MatrixX3d axes = drilling_axes(mesh, dofs);
    const auto node =
        first_wrong(mesh, dofs, load->group, axes, [&](const Vector3d& n, const Vector3d& arm) {
          const Vector3d of_node = moment + cross_matrix(arm) * force;
          return std::abs(n.dot(of_node)) > tilt * of_node.norm();
        });
    if (!node) continue;
    throw Error(fmt::format(
        "load on {}, so that a moment about it would only turn this node; give forces instead, {}",
        where(mesh, load->group, *node, axes.row(*node)), couple_instead));
  }
}

void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, std::span<const Support> supports,
                     std::span<const Spring> springs)
{
  const MatrixX3d axes = drilling_axes(mesh, dofs);
  const auto first = first_drilling_support(mesh, dofs, axes, supports);
  if (!first) return;
  const std::vector<int> held = held_dofs(mesh, dofs, supports);
  const int n_free = n_free_motions(free_parts(mesh, dofs, held, springs));
  const int n_without = n_free_motions(
      free_parts_under(mesh, dofs, {.held = held, .springs = springs, .axes = axes}));
  if (n_without == n_free) return;
  const auto& [name, node] = *first;
  throw Error(fmt::format(
      "support of {}, and nothing else holds the body there; hold displacements of another node as "
      "well, {}",
      where(mesh, name, node, axes.row(node)), couple_instead));
}

}  // namespace chladni::plate
