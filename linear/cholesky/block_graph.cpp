#include "linear/cholesky/block_graph.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "common/petsc.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/matrix_graph.hpp"

namespace chladni::linear {

namespace {

/// The columns of one local row.
std::vector<PetscInt> pattern(Mat A, PetscInt row)
{
  PetscInt n = 0;
  const PetscInt* columns = nullptr;
  petsc::check(MatGetRow(A, row, &n, &columns, nullptr));
  std::vector<PetscInt> copy(columns, columns + n);
  petsc::check(MatRestoreRow(A, row, &n, &columns, nullptr));
  return copy;
}

}  // namespace

OwnBlocks own_blocks(Mat A, IS rows)
{
  PetscInt first = 0, last = 0, block_size = 1;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  petsc::check(MatGetBlockSize(A, &block_size));
  OwnBlocks own;
  if (rows == nullptr) {
    own.rows.resize(std::size_t(last - first));
    std::iota(own.rows.begin(), own.rows.end(), first);
  } else {
    own.rows = petsc::own_indices(rows);
  }
  std::vector<PetscInt> before, now;
  for (const PetscInt row : own.rows) {
    now = block_size > 1 ? std::vector{row / block_size} : pattern(A, row);
    const bool is_alike = !own.block.empty() && now == before;
    own.block.push_back(is_alike ? own.block.back() : own.n_blocks());
    before.swap(now);
  }
  return own;
}

std::vector<int> block_of_rows(Mat A, const OwnBlocks& own)
{
  const MPI_Comm comm = petsc::communicator(A);
  PetscInt begin = 0, end = 0, n = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  petsc::check(MatGetSize(A, &n, nullptr));
  const int first = first_number(own.n_blocks(), comm);
  std::vector<int> here(std::size_t(end - begin), left_out);
  for (std::size_t i = 0; i < own.rows.size(); ++i)
    here[own.rows[i] - begin] = first + own.block[i];
  std::vector<int> all = gather(std::move(here), MPI_INT, comm);
  all.resize(n);
  MPI_Bcast(all.data(), n, MPI_INT, 0, comm);
  return all;
}

BlockGraph own_graph(Mat A, const OwnBlocks& own, const std::vector<int>& block_of)
{
  BlockGraph graph{.degrees = std::vector(std::size_t(own.n_blocks()), 0), .neighbours = {}};
  const int last = block_of.empty() ? left_out : std::ranges::max(block_of);
  std::vector<int> seen_by(std::size_t(last + 1), left_out);
  for (std::size_t i = 0; i < own.rows.size(); ++i) {
    const int self = block_of[own.rows[i]];
    seen_by[self] = self;
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    petsc::check(MatGetRow(A, own.rows[i], &n, &columns, nullptr));
    for (PetscInt k = 0; k < n; ++k) {
      const int other = block_of[columns[k]];
      if (other == left_out || seen_by[other] == self) continue;
      seen_by[other] = self;
      graph.neighbours.push_back(other);
      ++graph.degrees[own.block[i]];
    }
    petsc::check(MatRestoreRow(A, own.rows[i], &n, &columns, nullptr));
  }
  return graph;
}

void merge_alike(BlockGraph& graph, std::vector<int>& block_of, MPI_Comm comm)
{
  const auto n_own = static_cast<int>(graph.degrees.size());
  const int first = first_number(n_own, comm);
  ByFingerprint<int> known;
  std::vector<int> merged;  // the new number of each
  auto next = graph.neighbours.cbegin();
  for (int b = 0; b < n_own; ++b) {
    Fingerprint neighbours;
    neighbours.add(std::uint64_t(first) + std::uint64_t(b));
    for (int k = 0; k < graph.degrees[b]; ++k) neighbours.add(std::uint64_t(*next++));
    merged.push_back(known.try_emplace(neighbours, std::ssize(known)).first->second);
  }
  const int first_merged = first_number(static_cast<int>(known.size()), comm);
  for (int& number : merged) number += first_merged;
  const std::vector<int> new_number = gather_on_all(merged, MPI_INT, comm);
  for (int& block : block_of)
    if (block != left_out) block = new_number[block];

  BlockGraph left;
  std::vector<int> seen_by(new_number.size(), left_out);
  next = graph.neighbours.cbegin();
  for (int b = 0; b < n_own; ++b) {
    const auto last = next + graph.degrees[b];
    const int self = merged[b];
    const bool is_first = std::cmp_equal(self - first_merged, left.degrees.size());
    if (is_first) {
      const std::size_t before = left.neighbours.size();
      seen_by[self] = self;
      for (; next != last; ++next) {
        const int other = new_number[*next];
        if (std::exchange(seen_by[other], self) != self) left.neighbours.push_back(other);
      }
      left.degrees.push_back(static_cast<int>(left.neighbours.size() - before));
    }
    next = last;
  }
  graph = std::move(left);
}

}  // namespace chladni::linear
