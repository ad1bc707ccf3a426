#include "plate/block_rows.hpp"

#include <algorithm>
#include <cassert>

namespace chladni::plate {

namespace {

/// Rows of scalars with global columns, as PETSc reads them.
struct ScalarRows {
  std::vector<PetscInt> start, column;
  std::vector<double> value;
};

ScalarRows scalar_rows(const BlockPattern& pattern, const std::vector<double>& values)
{
  const int n = pattern.n;
  const std::ptrdiff_t block_size = n * n;
  ScalarRows rows;
  rows.start.reserve(n * pattern.n_rows() + 1);
  rows.start.push_back(0);
  const auto n_nonzeros = static_cast<std::size_t>(
      std::ranges::count_if(values, [](double value) { return value != 0.0; }));
  rows.column.reserve(n_nonzeros + n * pattern.n_rows());
  rows.value.reserve(n_nonzeros + n * pattern.n_rows());
  for (PetscInt row = 0; row < pattern.n_rows(); ++row) {
    for (int i = 0; i < n; ++i) {
      const PetscInt diagonal = n * (pattern.first + row) + i;
      for (std::ptrdiff_t k = pattern.start[row]; k < pattern.start[row + 1]; ++k) {
        for (int j = 0; j < n; ++j) {
          const double value = values[k * block_size + i * n + j];
          const PetscInt column = n * pattern.column[k] + j;
          if (value == 0.0 && column != diagonal) continue;
          rows.column.push_back(column);
          rows.value.push_back(value);
        }
      }
      rows.start.push_back(static_cast<PetscInt>(rows.column.size()));
    }
  }
  return rows;
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

BlockRows::BlockRows(const BlockPattern& pattern)
    : pattern_(pattern), values_(pattern.column.size() * pattern.n * pattern.n, 0.0)
{}

void BlockRows::add(const Eigen::MatrixXd& A_e, std::span<const PetscInt> nodes)
{
  const int n = pattern_.n;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const PetscInt row = nodes[a] - pattern_.first;
    if (row < 0 || row >= pattern_.n_rows()) continue;
    const auto begin = pattern_.column.begin() + pattern_.start[row];
    const auto end = pattern_.column.begin() + pattern_.start[row + 1];
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      const auto it = std::lower_bound(begin, end, nodes[b]);
      assert(it != end && *it == nodes[b]);
      double* block = values_.data() + (it - pattern_.column.begin()) * n * n;
      // Of a symmetric matrix a column of the transposed block is a row, and contiguous.
      for (int i = 0; i < n; ++i) {
        const double* source =
            &A_e(static_cast<Eigen::Index>(n * b), static_cast<Eigen::Index>(n * a + i));
        for (int j = 0; j < n; ++j) block[i * n + j] += source[j];
      }
    }
  }
}

petsc::Matrix BlockRows::to_matrix(MPI_Comm comm)
{
  const int n = pattern_.n;
  const ScalarRows rows = scalar_rows(pattern_, values_);
  values_ = std::vector<double>();  // frees the memory before PETSc copies the rows
  petsc::Matrix A;
  petsc::check(MatCreate(comm, A.put()));
  petsc::check(MatSetSizes(A, n * pattern_.n_rows(), n * pattern_.n_rows(), PETSC_DETERMINE,
                           PETSC_DETERMINE));
  petsc::check(MatSetType(A, MATAIJ));
  petsc::check(MatSetBlockSize(A, n));
  petsc::check(
      MatSeqAIJSetPreallocationCSR(A, rows.start.data(), rows.column.data(), rows.value.data()));
  petsc::check(
      MatMPIAIJSetPreallocationCSR(A, rows.start.data(), rows.column.data(), rows.value.data()));
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  petsc::check(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return A;
}

}  // namespace chladni::plate
