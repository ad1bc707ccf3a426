#include "plate/assemble.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "plate/block_rows.hpp"
#include "plate/directors.hpp"
#include "plate/point_elements.hpp"
#include "plate/section_map.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Calls visit(block, element) for each element with a node that `first <= number < last` owns.
template <typename Visit>
void for_owned_elements(const mesh::Mesh& mesh, const DofMap& dofs, int rank, const Visit& visit)
{
  const int first = dofs.range[rank];
  const int last = dofs.range[rank + 1];
  const auto owned = [&](int node) {
    return dofs.number[node] >= first && dofs.number[node] < last;
  };
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (std::ranges::any_of(block.element_nodes(e), owned)) visit(block, e);
    }
  }
}

std::vector<PetscInt> active_numbers(const DofMap& dofs, std::span<const int> nodes)
{
  std::vector<PetscInt> numbers;
  for (const int node : nodes) numbers.push_back(dofs.number[node]);
  return numbers;
}

/// The nodes that share an element with each node that this rank owns.
class Neighbours {
 public:
  Neighbours(const DofMap& dofs, int rank)
      : dofs_(dofs), first_(dofs.range[rank]), lists_(dofs.range[rank + 1] - first_)
  {}

  /// All nodes of an element are neighbours.
  void connect(std::span<const int> nodes)
  {
    const std::vector<PetscInt> numbers = active_numbers(dofs_, nodes);
    for (const PetscInt row : numbers) {
      if (row < first_ || row >= first_ + std::ssize(lists_)) continue;
      auto& list = lists_[row - first_];
      list.insert(list.end(), numbers.begin(), numbers.end());
    }
  }
  BlockPattern pattern() &&
  {
    return block_pattern(dofs_.n_components(), first_, std::move(lists_));
  }

 private:
  const DofMap& dofs_;
  PetscInt first_;
  std::vector<std::vector<PetscInt>> lists_;
};

BlockPattern pattern_of(const mesh::Mesh& mesh, std::span<const PointElement> points,
                        const DofMap& dofs, int rank)
{
  Neighbours neighbours(dofs, rank);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    neighbours.connect(block.element_nodes(e));
  });
  for (const PointElement& point : points) neighbours.connect(point.nodes);
  return std::move(neighbours).pattern();
}

/// A_e <- T_e^T A_e T_e with u = u_ref + theta_ref x arm, theta = theta_ref of dependent nodes.
MatrixXd eliminate_dependents(MatrixXd A_e, const DofMap& dofs, std::span<const int> nodes)
{
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!dofs.is_dependent(nodes[i])) continue;
    const auto [x, y, z] = dofs.arm(nodes[i]);
    Eigen::Matrix3d R;  // theta x arm = R theta
    R << 0.0, z, -y, -z, 0.0, x, y, -x, 0.0;
    const auto u = static_cast<Index>(6 * i);
    A_e.middleCols<3>(u + 3) += A_e.middleCols<3>(u) * R;
    A_e.middleRows<3>(u + 3) += R.transpose() * A_e.middleRows<3>(u);
  }
  return A_e;
}

/// Rows and columns of the components that the system has.
MatrixXd only_components(MatrixXd A_e, const DofMap& dofs)
{
  if (dofs.n_components() == 6) return A_e;
  std::vector<Index> kept;
  for (Index node = 0; node < A_e.rows(); node += 6) {
    for (const int c : dofs.components) kept.push_back(node + c);
  }
  return A_e(kept, kept);
}

/// Adds element matrices of 6 DOFs for each node.
void add(BlockRows& A, MatrixXd A_e, const DofMap& dofs, std::span<const int> nodes)
{
  A.add(only_components(eliminate_dependents(std::move(A_e), dofs, nodes), dofs),
        active_numbers(dofs, nodes));
}

/// C of the dampers, whose few entries have a pattern of their own; null without one.
petsc::Matrix damping_matrix(std::span<const PointElement> points, const DofMap& dofs,
                             MPI_Comm comm)
{
  const auto is_damper = [](const PointElement& point) { return point.C.size() > 0; };
  if (std::ranges::none_of(points, is_damper)) return {};
  Neighbours neighbours(dofs, petsc::rank(comm));
  for (const PointElement& point : points) {
    if (is_damper(point)) neighbours.connect(point.nodes);
  }
  const BlockPattern pattern = std::move(neighbours).pattern();
  BlockRows C(pattern);
  for (const PointElement& point : points) {
    if (is_damper(point)) add(C, point.C, dofs, point.nodes);
  }
  return C.to_matrix(comm);
}

}  // namespace

System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  const SectionMap sections = map_sections(mesh, structure);
  const std::vector<PointElement> points = point_elements(mesh, structure, dofs);
  const NodeVectors normals = mean_normals(mesh);
  const BlockPattern pattern = pattern_of(mesh, points, dofs, rank);
  BlockRows K(pattern), M(pattern);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    ElementMatrices matrices = element_matrices(mesh, block, e, {sections, structure, normals});
    add(K, std::move(matrices.K), dofs, block.element_nodes(e));
    add(M, std::move(matrices.M), dofs, block.element_nodes(e));
  });
  for (const PointElement& point : points) {
    if (point.K.size() > 0) add(K, point.K, dofs, point.nodes);
    if (point.M.size() > 0) add(M, point.M, dofs, point.nodes);
  }
  System system{.K = K.to_matrix(comm),
                .M = M.to_matrix(comm),
                .C = damping_matrix(points, dofs, comm),
                .dofs = {}};
  system.dofs = std::move(dofs);
  return system;
}

System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm)
{
  return assemble(mesh, Structure{.shells = sections}, std::move(dofs), comm);
}

}  // namespace chladni::plate
