#include "plate/block_rows.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace chladni::plate {

namespace {

/// Calls visit(row, columns, values) for each row of scalars, counted from the first one here, with
/// its entries but the zeros off the diagonal; columns are global.
template <typename Visit>
void for_scalar_rows(const BlockPattern& pattern, const std::vector<double>& values,
                     const Visit& visit)
{
  const int n = pattern.n;
  std::vector<PetscInt> columns;
  std::vector<double> row_values;
  for (PetscInt row = 0; row < n * pattern.n_rows(); ++row) {
    const std::ptrdiff_t begin = pattern.start[row / n], end = pattern.start[row / n + 1];
    const PetscInt diagonal = n * pattern.first + row;
    columns.resize(static_cast<std::size_t>(n * (end - begin)));
    row_values.resize(columns.size());
    std::size_t count = 0;
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      const double* of_block = values.data() + (k * n + row % n) * n;
      const PetscInt first_column = n * pattern.column[k];
      for (int j = 0; j < n; ++j) {  // without a branch: zeros are overwritten by what follows
        columns[count] = first_column + j;
        row_values[count] = of_block[j];
        count += static_cast<std::size_t>(of_block[j] != 0.0 || first_column + j == diagonal);
      }
    }
    visit(row, std::span(columns).first(count), std::span(row_values).first(count));
  }
}

/// Numbers of entries of each row in the columns of this rank, and in the others.
struct RowSizes {
  std::vector<PetscInt> own, other;
};

RowSizes row_sizes(const BlockPattern& pattern, const std::vector<double>& values)
{
  const PetscInt first = pattern.n * pattern.first;
  const PetscInt last = first + pattern.n * pattern.n_rows();
  RowSizes sizes;
  for_scalar_rows(pattern, values, [&](PetscInt, auto columns, auto) {
    const auto begin = std::ranges::lower_bound(columns, first);
    const auto end = std::ranges::lower_bound(columns, last);
    sizes.own.push_back(static_cast<PetscInt>(end - begin));
    sizes.other.push_back(static_cast<PetscInt>(std::ssize(columns) - (end - begin)));
  });
  return sizes;
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

void BlockRows::add(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places)
{
  const int n = pattern_.n;
  const Eigen::Index n_nodes = A_e.rows() / n;
  for (Eigen::Index a = 0; a < n_nodes; ++a) {
    for (Eigen::Index b = 0; b < n_nodes; ++b) {
      const std::ptrdiff_t place = places[static_cast<std::size_t>(a * n_nodes + b)];
      if (place < 0) continue;
      double* block = values_.data() + place * n * n;
      // Of a symmetric matrix a column of the transposed block is a row, and contiguous.
      for (int i = 0; i < n; ++i) {
        const double* source = &A_e(n * b, n * a + i);
        for (int j = 0; j < n; ++j) block[i * n + j] += source[j];
      }
    }
  }
}

petsc::Matrix BlockRows::to_matrix(MPI_Comm comm)
{
  const PetscInt n_rows = pattern_.n * pattern_.n_rows();
  const PetscInt first = pattern_.n * pattern_.first;
  const RowSizes sizes = row_sizes(pattern_, values_);
  petsc::Matrix A;
  petsc::check(MatCreate(comm, A.put()));
  petsc::check(MatSetSizes(A, n_rows, n_rows, PETSC_DETERMINE, PETSC_DETERMINE));
  petsc::check(MatSetType(A, MATAIJ));
  petsc::check(MatSetBlockSize(A, pattern_.n));
  petsc::check(MatSeqAIJSetPreallocation(A, 0, sizes.own.data()));
  petsc::check(MatMPIAIJSetPreallocation(A, 0, sizes.own.data(), 0, sizes.other.data()));
  petsc::check(MatSetOption(A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  for_scalar_rows(pattern_, values_, [&](PetscInt i, auto columns, auto values) {
    const PetscInt row = first + i;
    petsc::check(MatSetValues(A, 1, &row, static_cast<PetscInt>(columns.size()), columns.data(),
                              values.data(), INSERT_VALUES));
  });
  values_ = std::vector<double>();
  petsc::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  petsc::check(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return A;
}

}  // namespace chladni::plate
