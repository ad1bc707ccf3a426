#include "reduce/partition.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/cholesky/elimination_order.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/log_event.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// What is wrong with the masters of this rank: count of those out of its range and of doubles.
std::array<PetscInt, 2> count_faults(const std::vector<PetscInt>& sorted, PetscInt first,
                                     PetscInt last)
{
  const auto outside =
      std::ranges::count_if(sorted, [&](PetscInt i) { return i < first || i >= last; });
  PetscInt doubles = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) doubles += sorted[i] == sorted[i - 1];
  return {static_cast<PetscInt>(outside), doubles};
}

std::vector<PetscInt> sorted_indices(IS set)
{
  std::vector<PetscInt> sorted = petsc::own_indices(set);
  std::ranges::sort(sorted);
  return sorted;
}

/// All DOFs of a node stay together (block size of K) when masters and slaves are whole nodes.
void keep_block_size(Mat K, IS slaves)
{
  PetscInt block_size = 1;
  petsc::check(MatGetBlockSize(K, &block_size));
  const std::vector<PetscInt> s = sorted_indices(slaves);
  int whole = s.size() % block_size == 0 ? 1 : 0;
  for (std::size_t i = 0; whole == 1 && i < s.size(); i += block_size)
    if (s[i] % block_size != 0 || s[i + block_size - 1] != s[i] + block_size - 1) whole = 0;
  MPI_Allreduce(MPI_IN_PLACE, &whole, 1, MPI_INT, MPI_MIN, petsc::communicator(K));
  if (whole == 1) petsc::check(ISSetBlockSize(slaves, block_size));
}

/// This rank's share of values that rank 0 has of all ranks.
std::vector<int> scattered(const std::vector<int>& all, std::size_t n_own, MPI_Comm comm)
{
  const std::vector<int> counts = linear::counts_of_ranks(n_own, comm);
  const std::vector<int> starts = linear::offsets(counts);
  std::vector<int> own(n_own);
  MPI_Scatterv(all.data(), counts.data(), starts.data(), MPI_INT, own.data(),
               static_cast<int>(n_own), MPI_INT, 0, comm);
  return own;
}

}  // namespace

DofPartition partition(Mat K, IS masters, PetscInt least)
{
  const MPI_Comm comm = petsc::communicator(K);
  PetscInt first = 0;
  PetscInt last = 0;
  PetscInt n = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  petsc::check(MatGetSize(K, &n, nullptr));
  const std::vector<PetscInt> sorted = sorted_indices(masters);
  const auto faults = count_faults(sorted, first, last);
  std::array<PetscInt, 3> total{faults[0], faults[1], static_cast<PetscInt>(sorted.size())};
  MPI_Allreduce(MPI_IN_PLACE, total.data(), 3, MPIU_INT, MPI_SUM, comm);
  if (total[0] + total[1] > 0) {
    throw Error(
        fmt::format("partition: {} masters are out of range (0 to {}, each on the rank that "
                    "owns it) and {} are given twice",
                    total[0], n - 1, total[1]));
  }
  if (total[2] < least || total[2] >= n) {
    throw Error(
        fmt::format("partition: {} masters of {} DOFs; give at least one and leave at least "
                    "one slave",
                    total[2], n));
  }
  DofPartition dofs;
  petsc::check(ISCreateGeneral(comm, static_cast<PetscInt>(sorted.size()), sorted.data(),
                               PETSC_COPY_VALUES, dofs.masters.put()));
  petsc::check(ISComplement(dofs.masters, first, last, dofs.slaves.put()));
  keep_block_size(K, dofs.slaves);
  return dofs;
}

std::vector<int> order_slaves(DofPartition& dofs, Mat K, Mat M)
{
  struct Slave {
    int part, place;
    PetscInt dof;
    auto operator<=>(const Slave&) const = default;
  };
  const MPI_Comm comm = petsc::communicator(K);
  const std::vector<PetscInt> before = petsc::own_indices(dofs.slaves);
  const std::vector<int> places = [&] {
    const linear::LogEvent event(linear::Event::ordering);
    return scattered(linear::elimination_order(K, dofs.slaves), before.size(), comm);
  }();
  std::vector<Slave> slaves;
  for (std::size_t i = 0; i < before.size(); ++i) slaves.push_back({0, places[i], before[i]});
  int part = 0;
  for (const petsc::IndexSet& rows : linear::decoupled_rows(K, M, dofs.slaves)) {
    for (const PetscInt dof : petsc::own_indices(rows))
      slaves[std::size_t(std::ranges::lower_bound(before, dof) - before.begin())].part = part;
    ++part;
  }
  std::ranges::sort(slaves);
  std::vector<PetscInt> now;
  std::vector<int> order;
  for (const Slave& slave : slaves) {
    now.push_back(slave.dof);
    order.push_back(slave.place);
  }
  petsc::IndexSet ordered;
  petsc::check(ISCreateGeneral(comm, static_cast<PetscInt>(now.size()), now.data(),
                               PETSC_COPY_VALUES, ordered.put()));
  dofs.slaves = std::move(ordered);
  return linear::gather(std::move(order), MPI_INT, comm);
}

PetscInt dof_of_slave(const DofPartition& dofs, PetscInt row)
{
  const MPI_Comm comm = petsc::communicator(dofs.slaves);
  const std::vector<PetscInt> own = petsc::own_indices(dofs.slaves);
  const PetscInt first = petsc::indices_before(dofs.slaves);
  PetscInt dof = row >= first && row < first + std::ssize(own) ? own[row - first] : -1;
  MPI_Allreduce(MPI_IN_PLACE, &dof, 1, MPIU_INT, MPI_MAX, comm);
  return dof;
}

std::vector<PetscInt> all_slaves(const DofPartition& dofs)
{
  return linear::gather_on_all(petsc::own_indices(dofs.slaves), MPIU_INT,
                               petsc::communicator(dofs.slaves));
}

Blocks split(Mat A, const DofPartition& dofs, const std::string& scratch)
{
  return {.mm = linear::own_submatrix(A, dofs.masters, dofs.masters),
          .ms = linear::own_submatrix(A, dofs.masters, dofs.slaves),
          .sm = linear::own_submatrix(A, dofs.slaves, dofs.masters),
          .ss = linear::own_submatrix(A, dofs.slaves, dofs.slaves, scratch)};
}

namespace {

/// The rows of a set that this rank holds, counted from the first row of X.
struct OwnRows {
  std::vector<PetscInt> rows;
  PetscInt before;  ///< rows of the set on the ranks before
  PetscInt n_all = 0;

  OwnRows(Mat X, IS set) : rows(petsc::own_rows(set, X)), before(petsc::indices_before(set))
  {
    petsc::check(ISGetSize(set, &n_all));
  }
  PetscInt size() const { return static_cast<PetscInt>(rows.size()); }
};

}  // namespace

petsc::Matrix slave_rows(Mat X, const DofPartition& dofs, Mat like)
{
  const OwnRows slaves(X, dofs.slaves);
  const linear::LocalRows x(X);
  petsc::Matrix X_s = linear::uninitialized_dense(like, x.n_cols());
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X_s, &values));
  for (PetscInt j = 0; j < x.n_cols(); ++j)
    for (PetscInt i = 0; i < slaves.size(); ++i)
      values[i + std::size_t(j) * slaves.size()] = x(slaves.rows[i], j);
  petsc::check(MatDenseRestoreArrayWrite(X_s, &values));
  return X_s;
}

MatrixXd master_rows(Mat X, const DofPartition& dofs)
{
  const OwnRows masters(X, dofs.masters);
  MatrixXd X_m = MatrixXd::Zero(masters.n_all, linear::LocalRows(X).n_cols());
  {
    const linear::LocalRows x(X);
    for (PetscInt j = 0; j < x.n_cols(); ++j)
      for (PetscInt i = 0; i < masters.size(); ++i)
        X_m(masters.before + i, j) = x(masters.rows[i], j);
  }
  linear::sum_over_ranks(linear::values_of(X_m), petsc::communicator(X));
  return X_m;
}

petsc::Matrix block_of(const linear::LocalRows& X, const std::vector<PetscInt>& rows,
                       std::span<const int> columns, Mat like)
{
  petsc::Matrix block = linear::uninitialized_dense(like, std::ssize(columns));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(block, &values));
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      values[i + j * rows.size()] = X(rows[i], columns[j]);
  petsc::check(MatDenseRestoreArrayWrite(block, &values));
  return block;
}

void set_rows(Mat X, const DofPartition& dofs, const MatrixXd& X_m, Mat X_s)
{
  const OwnRows masters(X, dofs.masters), slaves(X, dofs.slaves);
  const linear::LocalRows x_s(X_s);
  PetscScalar* values = nullptr;
  PetscInt ld = 0;
  petsc::check(MatDenseGetLDA(X, &ld));
  petsc::check(MatDenseGetArray(X, &values));
  for (PetscInt j = 0; j < x_s.n_cols(); ++j) {
    PetscScalar* column = values + std::size_t(j) * ld;
    for (PetscInt i = 0; i < slaves.size(); ++i) column[slaves.rows[i]] = x_s(i, j);
    for (PetscInt i = 0; i < masters.size(); ++i)
      column[masters.rows[i]] = X_m(masters.before + i, j);
  }
  petsc::check(MatDenseRestoreArray(X, &values));
}

petsc::Matrix beside(Mat R, Mat X, PetscInt k)
{
  const PetscInt r = linear::LocalRows(R).n_cols();
  petsc::Matrix both = linear::uninitialized_dense(R, r + k);
  if (r > 0) petsc::check(MatCopy(R, linear::ColumnRange(both, 0, r), SAME_NONZERO_PATTERN));
  if (k > 0) {
    petsc::check(MatCopy(linear::ColumnRange(X, 0, k), linear::ColumnRange(both, r, r + k),
                         SAME_NONZERO_PATTERN));
  }
  return both;
}

}  // namespace chladni::reduce
