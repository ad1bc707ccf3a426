#include "plate/assemble.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "common/error.hpp"
#include "plate/block_rows.hpp"
#include "plate/directors.hpp"
#include "plate/point_elements.hpp"
#include "plate/section_map.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The active numbers on which the motion of some nodes depends, ascending.
std::vector<PetscInt> active_numbers(const DofMap& dofs, std::span<const int> nodes)
{
  std::vector<PetscInt> numbers;
  for (const int node : nodes) {
    if (dofs.is_plain(node)) {
      numbers.push_back(dofs.number[node]);
      continue;
    }
    for (const MotionTerm& term : dofs.motion(node)) numbers.push_back(term.number);
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Calls visit(block, element, its active numbers) for each element that depends on a number that
/// this rank owns.
template <typename Visit>
void for_owned_elements(const mesh::Mesh& mesh, const DofMap& dofs, int rank, const Visit& visit)
{
  const int first = dofs.range[rank];
  const int last = dofs.range[rank + 1];
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::vector<PetscInt> numbers = active_numbers(dofs, block.element_nodes(e));
      const auto owned = std::ranges::lower_bound(numbers, first);
      if (owned != numbers.end() && *owned < last) visit(block, e, numbers);
    }
  }
}

/// Active numbers of the neighbours of each node that this rank owns.
class Neighbours {
 public:
  Neighbours(const DofMap& dofs, int rank)
      : dofs_(dofs), first_(dofs.range[rank]), lists_(dofs.range[rank + 1] - first_)
  {}

  /// All active numbers of an element are neighbours.
  void connect(const std::vector<PetscInt>& numbers)
  {
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
  for_owned_elements(mesh, dofs, rank,
                     [&](const auto&, int, const auto& numbers) { neighbours.connect(numbers); });
  for (const PointElement& point : points) neighbours.connect(active_numbers(dofs, point.nodes));
  return std::move(neighbours).pattern();
}

/// u_e = T_e q of the points where the DOFs of an element stand, with q at active numbers.
struct ElementMotion {
  std::vector<PetscInt> numbers;
  MatrixXd T_e;  ///< [6 n_e x 6 n]; empty where u_e = q
};

/// Through the couplings to the nodes of the mesh, and along the arms from these to the points.
/// @param arms  [n_e x 3] m; empty for zero
ElementMotion element_motion(const DofMap& dofs, std::span<const int> nodes,
                             const NodeVectors& arms)
{
  const bool plain = std::ranges::all_of(nodes, [&](int node) { return dofs.is_plain(node); });
  ElementMotion motion;
  if (plain && arms.size() == 0) {
    for (const int node : nodes) motion.numbers.push_back(dofs.number[node]);
    return motion;
  }
  motion.numbers = active_numbers(dofs, nodes);
  motion.T_e = MatrixXd::Zero(6 * std::ssize(nodes), 6 * std::ssize(motion.numbers));
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    Matrix6d arm = Matrix6d::Identity();
    if (arms.size() > 0) arm = rigid_arm(arms.row(i));
    for (const MotionTerm& term : dofs.motion(nodes[i])) {
      const auto column =
          std::ranges::lower_bound(motion.numbers, term.number) - motion.numbers.begin();
      motion.T_e.block<6, 6>(6 * i, 6 * column) += arm * term.T;
    }
  }
  return motion;
}

/// Rows and columns of the components that the system has.
MatrixXd only_components(const MatrixXd& A_e, const DofMap& dofs)
{
  std::vector<Index> kept;
  for (Index node = 0; node < A_e.rows(); node += 6) {
    for (const int c : dofs.components) kept.push_back(node + c);
  }
  return A_e(kept, kept);
}

/// Adds an element matrix of 6 DOFs for each node in the coordinates of the system.
/// @param places  of the blocks of motion.numbers
void add(BlockRows& A, MatrixXd A_e, const ElementMotion& motion, const DofMap& dofs,
         std::span<const std::ptrdiff_t> places)
{
  const MatrixXd& T_e = motion.T_e;
  if (T_e.size() > 0) A_e = T_e.transpose() * A_e * T_e;
  if (dofs.n_components() < 6) A_e = only_components(A_e, dofs);
  A.add(A_e, places);
}

/// C of the dampers, whose few entries have a pattern of their own; null without one.
petsc::Matrix damping_matrix(std::span<const PointElement> points, const DofMap& dofs,
                             MPI_Comm comm)
{
  const auto is_damper = [](const PointElement& point) { return point.C.size() > 0; };
  if (std::ranges::none_of(points, is_damper)) return {};
  Neighbours neighbours(dofs, petsc::rank(comm));
  for (const PointElement& point : points) {
    if (is_damper(point)) neighbours.connect(active_numbers(dofs, point.nodes));
  }
  const BlockPattern pattern = std::move(neighbours).pattern();
  BlockRows C(pattern);
  for (const PointElement& point : points) {
    if (!is_damper(point)) continue;
    const ElementMotion motion = element_motion(dofs, point.nodes, {});
    add(C, point.C, motion, dofs, block_places(pattern, motion.numbers));
  }
  return C.to_matrix(comm);
}

/// The DOFs of an average stand in those of its group, whatever component these are.
void check_components(const DofMap& dofs)
{
  if (dofs.n_components() == 6 || dofs.combined_motions.empty()) return;
  throw Error(
      "an averaging coupling needs all six DOFs of each node; use a rigid one, or all six DOFs");
}

}  // namespace

System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  check_components(dofs);
  const SectionMap sections = map_sections(mesh, structure);
  const std::vector<PointElement> points = point_elements(mesh, structure, dofs);
  const NodeVectors normals = mean_normals(mesh);
  const BlockPattern pattern = pattern_of(mesh, points, dofs, rank);
  BlockRows K(pattern), M(pattern);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e, const auto&) {
    auto [matrices, arms] = element_matrices(mesh, block, e, {sections, structure, normals});
    const ElementMotion motion = element_motion(dofs, block.element_nodes(e), arms);
    const std::vector<std::ptrdiff_t> places = block_places(pattern, motion.numbers);
    add(K, std::move(matrices.K), motion, dofs, places);
    add(M, std::move(matrices.M), motion, dofs, places);
  });
  for (const PointElement& point : points) {
    const ElementMotion motion = element_motion(dofs, point.nodes, {});
    const std::vector<std::ptrdiff_t> places = block_places(pattern, motion.numbers);
    if (point.K.size() > 0) add(K, point.K, motion, dofs, places);
    if (point.M.size() > 0) add(M, point.M, motion, dofs, places);
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
