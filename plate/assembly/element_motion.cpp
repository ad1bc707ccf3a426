#include "plate/assembly/element_motion.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCore>

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Active numbers of the neighbours of each node that this rank owns.
class Neighbours {
 public:
  Neighbours(const DofMap& dofs, int rank)
      : dofs_(dofs), first_(dofs.first_number(rank)), lists_(dofs.first_number(rank + 1) - first_)
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

/// Rows and columns of the components that the system has.
MatrixXd only_components(const MatrixXd& A_e, const DofMap& dofs)
{
  std::vector<Index> kept;
  for (Index node = 0; node < A_e.rows(); node += 6)
    for (const int c : dofs.components()) kept.push_back(node + c);
  return A_e(kept, kept);
}

/// Numbers that other nodes follow.
std::vector<PetscInt> followed_numbers(const DofMap& dofs)
{
  std::vector<PetscInt> numbers;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    if (dofs.is_plain(node)) continue;
    for (const MotionTerm& term : dofs.motion(node)) numbers.push_back(term.number);
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// T_e^T A_e T_e. Where nodes move by all harmonics of a ring there are many columns, mostly of
/// zeros.
MatrixXd congruent(const MatrixXd& A_e, const MatrixXd& T_e)
{
  if (T_e.cols() < 2 * T_e.rows()) return T_e.transpose() * A_e * T_e;
  const Eigen::SparseMatrix<double> T = T_e.sparseView();
  return T.transpose() * MatrixXd(A_e * T);
}

/// An element matrix in the coordinates of the system.
MatrixXd in_system(MatrixXd A_e, const ElementMotion& motion, const DofMap& dofs)
{
  const MatrixXd& T_e = motion.T_e;
  if (T_e.size() > 0) A_e = congruent(A_e, T_e);
  if (dofs.n_components() < 6) A_e = only_components(A_e, dofs);
  return A_e;
}

}  // namespace

std::vector<PetscInt> active_numbers(const DofMap& dofs, std::span<const int> nodes)
{
  std::vector<PetscInt> numbers;
  for (const int node : nodes) {
    if (dofs.is_plain(node)) {
      numbers.push_back(dofs.number(node));
      continue;
    }
    for (const MotionTerm& term : dofs.motion(node)) numbers.push_back(term.number);
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

bool may_depend_on(const DofMap& dofs, std::span<const int> nodes, int first, int last)
{
  return std::ranges::any_of(nodes, [&](int node) {
    const int number = dofs.number(node);
    return (number >= first && number < last) || !dofs.is_plain(node);
  });
}

ElementMotion element_motion(const DofMap& dofs, std::span<const int> nodes,
                             const NodeVectors& arms)
{
  const bool plain = std::ranges::all_of(nodes, [&](int node) { return dofs.is_plain(node); });
  ElementMotion motion;
  if (plain && arms.size() == 0) {
    for (const int node : nodes) motion.numbers.push_back(dofs.number(node));
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

void add(BlockRows& A, MatrixXd A_e, const ElementMotion& motion, const DofMap& dofs,
         std::span<const std::ptrdiff_t> places)
{
  A.add(in_system(std::move(A_e), motion, dofs), places);
}

void add_symmetric(BlockRows& A, MatrixXd A_e, const ElementMotion& motion, const DofMap& dofs,
                   std::span<const std::ptrdiff_t> places)
{
  MatrixXd symmetric = in_system(std::move(A_e), motion, dofs);
  for (Index j = 0; j < symmetric.cols(); ++j) {
    for (Index i = j + 1; i < symmetric.rows(); ++i) {
      const double mean = 0.5 * (symmetric(i, j) + symmetric(j, i));
      symmetric(i, j) = symmetric(j, i) = mean;
    }
  }
  A.add(symmetric, places);
}

MatrixXd block_matrix(std::span<const int> nodes, std::span<const mesh::MatrixEntry> entries)
{
  MatrixXd A = MatrixXd::Zero(6 * std::ssize(nodes), 6 * std::ssize(nodes));
  const Index second = nodes.size() == 1 ? 0 : 6;
  for (const auto& [row, column, value] : entries)
    A(row % 6, second + column % 6) = A(second + column % 6, row % 6) = value;
  return A;
}

BlockPattern element_pattern(const mesh::Mesh& mesh, std::span<const PointElement> points,
                             const DofMap& dofs, int rank)
{
  Neighbours neighbours(dofs, rank);
  if (mesh.matrices) {
    for (const auto* matrix : mesh.matrices->all()) {
      for_owned_blocks(*matrix, dofs, rank, [&](std::span<const int> nodes, auto) {
        neighbours.connect(active_numbers(dofs, nodes));
      });
    }
  } else {
    for_owned_elements(mesh, dofs, rank,
                       [&](const auto&, int, const auto& numbers) { neighbours.connect(numbers); });
  }
  for (const PointElement& point : points) neighbours.connect(active_numbers(dofs, point.nodes));
  for (const int dof : dofs.unused_dofs()) neighbours.connect({dof / dofs.n_components()});
  BlockPattern pattern = std::move(neighbours).pattern();
  pattern.full = followed_numbers(dofs);
  return pattern;
}

BlockPattern point_pattern(std::span<const PointElement> points, const DofMap& dofs, int rank)
{
  Neighbours neighbours(dofs, rank);
  for (const PointElement& point : points) neighbours.connect(active_numbers(dofs, point.nodes));
  return std::move(neighbours).pattern();
}

}  // namespace chladni::plate
