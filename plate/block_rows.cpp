#include "plate/block_rows.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>

namespace chladni::plate {

namespace {

/// Rows in CSR form: the entries in the columns of this rank, counted from its first, and in the
/// others.
struct SplitRows {
  std::vector<PetscInt> start{0};
  std::unique_ptr<PetscInt[]> column;
  std::vector<double> value;
  std::vector<PetscInt> other_start{0}, other_column;
  std::vector<double> other_value;
};

/// Turns the sums over a pattern into rows of scalars without zeros off the diagonal. The values
/// stay in the memory of the sums, since what is touched for the first time takes longest: a node's
/// rows never hold more than its blocks.
/// @param held    of each block the components (n * i + j), the diagonal among them
/// @param values  [n_blocks x n_held]
SplitRows split_rows(const BlockPattern& pattern, const std::vector<int>& held,
                     std::vector<double> values)
{
  const int n = pattern.n;
  const std::ptrdiff_t n_held = std::ssize(held);
  SplitRows rows;
  rows.column = std::make_unique_for_overwrite<PetscInt[]>(values.size());
  PetscInt count = 0;
  std::vector<double> of_node;
  for (PetscInt node = 0; node < pattern.n_rows(); ++node) {
    const std::ptrdiff_t begin = pattern.start[node], end = pattern.start[node + 1];
    of_node.assign(values.begin() + begin * n_held, values.begin() + end * n_held);
    std::ptrdiff_t s_begin = 0;
    for (int i = 0; i < n; ++i) {
      const std::ptrdiff_t s_end = std::ranges::lower_bound(held, n * (i + 1)) - held.begin();
      for (std::ptrdiff_t k = begin; k < end; ++k) {
        const double* of_block = of_node.data() + (k - begin) * n_held;
        const PetscInt own_node = pattern.column[k] - pattern.first;
        if (own_node >= 0 && own_node < pattern.n_rows()) {
          for (std::ptrdiff_t s = s_begin; s < s_end; ++s) {  // zeros are overwritten by the next
            const PetscInt column = n * own_node + held[s] - n * i;
            rows.column[count] = column;
            values[static_cast<std::size_t>(count)] = of_block[s];
            count += static_cast<PetscInt>(of_block[s] != 0.0 || column == n * node + i);
          }
          continue;
        }
        for (std::ptrdiff_t s = s_begin; s < s_end; ++s) {
          if (of_block[s] == 0.0) continue;
          rows.other_column.push_back(n * pattern.column[k] + held[s] - n * i);
          rows.other_value.push_back(of_block[s]);
        }
      }
      s_begin = s_end;
      rows.start.push_back(count);
      rows.other_start.push_back(static_cast<PetscInt>(rows.other_column.size()));
    }
  }
  rows.value = std::move(values);
  return rows;
}

/// A matrix on these rows, which it keeps: a copy of the arrays would cost as much as their sums.
petsc::Matrix matrix_of(SplitRows split, PetscInt n_rows, MPI_Comm comm)
{
  auto kept = std::make_unique<SplitRows>(std::move(split));
  petsc::Matrix A;
  if (petsc::size(comm) == 1)
    petsc::check(MatCreateSeqAIJWithArrays(comm, n_rows, n_rows, kept->start.data(),
                                           kept->column.get(), kept->value.data(), A.put()));
  else
    petsc::check(MatCreateMPIAIJWithSplitArrays(
        comm, n_rows, n_rows, PETSC_DETERMINE, PETSC_DETERMINE, kept->start.data(),
        kept->column.get(), kept->value.data(), kept->other_start.data(), kept->other_column.data(),
        kept->other_value.data(), A.put()));
  PetscContainer container = nullptr;
  petsc::check(PetscContainerCreate(comm, &container));
  petsc::check(PetscContainerSetPointer(container, kept.release()));
  petsc::check(PetscContainerSetUserDestroy(container, [](void* rows) -> PetscErrorCode {
    delete static_cast<SplitRows*>(rows);
    return 0;
  }));
  petsc::check(PetscObjectCompose(reinterpret_cast<PetscObject>(static_cast<Mat>(A)),
                                  "chladni_rows", reinterpret_cast<PetscObject>(container)));
  petsc::check(PetscContainerDestroy(&container));  // the matrix keeps it
  return A;
}

/// Bit n * i + j: some block of the transposed matrix has an entry (i, j).
std::uint64_t components_of(const Eigen::MatrixXd& A_e, int n)
{
  std::uint64_t found = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Eigen::Index n_nodes = A_e.rows() / n;
      const auto entries = A_e(Eigen::seqN(i, n_nodes, n), Eigen::seqN(j, n_nodes, n));
      if ((entries.array() != 0.0).any()) found |= std::uint64_t{1} << (n * j + i);
    }
  }
  return found;
}

}  // namespace

BlockPattern block_pattern(int n, PetscInt first, std::vector<std::vector<PetscInt>> neighbours)
{
  BlockPattern pattern{.n = n, .first = first, .start = {0}, .column = {}};
  for (std::vector<PetscInt>& row : neighbours) {
    std::ranges::sort(row);
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.start.push_back(std::ssize(pattern.column));
  }
  return pattern;
}

std::vector<std::ptrdiff_t> block_places(const BlockPattern& pattern,
                                         std::span<const PetscInt> nodes)
{
  std::vector<std::ptrdiff_t> places(nodes.size() * nodes.size(), -1);
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const PetscInt row = nodes[a] - pattern.first;
    if (row < 0 || row >= pattern.n_rows()) continue;
    const auto begin = pattern.column.begin() + pattern.start[row];
    const auto end = pattern.column.begin() + pattern.start[row + 1];
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      const auto it = std::lower_bound(begin, end, nodes[b]);
      assert(it != end && *it == nodes[b]);
      places[a * nodes.size() + b] = it - pattern.column.begin();
    }
  }
  return places;
}

void BlockRows::widen(std::uint64_t components)
{
  for (int i = 0; i < pattern_.n; ++i) components |= std::uint64_t{1} << (pattern_.n + 1) * i;
  std::vector<int> held;
  for (int c = 0; c < pattern_.n * pattern_.n; ++c)
    if (((components_ | components) >> c & 1) != 0) held.push_back(c);
  if (held.size() == held_.size()) return;
  std::vector<double> values(pattern_.column.size() * held.size(), 0.0);
  for (std::size_t s = 0; s < held_.size(); ++s) {
    const auto t =
        static_cast<std::size_t>(std::ranges::lower_bound(held, held_[s]) - held.begin());
    for (std::size_t k = 0; k < pattern_.column.size(); ++k)
      values[k * held.size() + t] = values_[k * held_.size() + s];
  }
  components_ |= components;
  held_ = std::move(held);
  values_ = std::move(values);
}

void BlockRows::add(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places)
{
  const int n = pattern_.n;
  const Eigen::Index n_nodes = A_e.rows() / n;
  const std::uint64_t components = components_of(A_e, n);
  if ((components & ~components_) != 0) widen(components);
  // A column of the transposed block is a row, and contiguous.
  std::vector<Eigen::Index> offset(held_.size());
  for (std::size_t s = 0; s < held_.size(); ++s)
    offset[s] = held_[s] / n * A_e.outerStride() + held_[s] % n;
  for (Eigen::Index a = 0; a < n_nodes; ++a) {
    for (Eigen::Index b = 0; b < n_nodes; ++b) {
      const std::ptrdiff_t place = places[static_cast<std::size_t>(a * n_nodes + b)];
      if (place < 0) continue;
      double* block = values_.data() + place * std::ssize(held_);
      const double* source = &A_e(n * b, n * a);
      for (std::size_t s = 0; s < offset.size(); ++s) block[s] += source[offset[s]];
    }
  }
}

petsc::Matrix BlockRows::to_matrix(MPI_Comm comm)
{
  widen(0);  // a matrix without elements has its diagonal, too
  SplitRows rows = split_rows(pattern_, held_, std::move(values_));
  petsc::Matrix A = matrix_of(std::move(rows), pattern_.n * pattern_.n_rows(), comm);
  petsc::check(MatSetBlockSize(A, pattern_.n));
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  petsc::check(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return A;
}

}  // namespace chladni::plate
