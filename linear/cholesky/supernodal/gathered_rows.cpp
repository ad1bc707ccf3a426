#include "linear/cholesky/supernodal/gathered_rows.hpp"

#include <numeric>
#include <span>

#include "linear/kernels/gather.hpp"

namespace chladni::linear {

namespace {

/// Numbers for each rank, one rank after the other.
template <typename T>
struct ByRank {
  std::vector<T> numbers;
  std::vector<int> counts;
};

/// What came from all ranks, one after the other, in memory that nothing else has touched.
template <typename T>
struct Received {
  std::unique_ptr<T[]> numbers;
  std::vector<int> counts;

  std::span<const T> all() const { return {numbers.get(), std::size_t(offsets(counts).back())}; }
};

template <typename T>
Received<T> exchanged(const ByRank<T>& sent, MPI_Datatype type, MPI_Comm comm)
{
  Received<T> received{.numbers = {}, .counts = std::vector<int>(sent.counts.size())};
  MPI_Alltoall(sent.counts.data(), 1, MPI_INT, received.counts.data(), 1, MPI_INT, comm);
  const std::vector<int> from = offsets(sent.counts), to = offsets(received.counts);
  received.numbers = std::make_unique_for_overwrite<T[]>(std::size_t(to.back()));
  MPI_Alltoallv(sent.numbers.data(), sent.counts.data(), from.data(), type, received.numbers.get(),
                received.counts.data(), to.data(), type, comm);
  return received;
}

/// Rows, by the rank that owns them.
ByRank<PetscInt> by_owner(Mat A, const std::vector<PetscInt>& rows)
{
  const PetscInt* first_rows = nullptr;
  petsc::check(MatGetOwnershipRanges(A, &first_rows));
  ByRank<PetscInt> asked{.numbers = rows,
                         .counts = std::vector<int>(petsc::size(petsc::communicator(A)), 0)};
  std::size_t owner = 0;
  for (const PetscInt row : rows) {
    while (row >= first_rows[owner + 1]) ++owner;
    ++asked.counts[owner];
  }
  return asked;
}

}  // namespace

GatheredRows::GatheredRows(Mat A, const std::vector<char>& is_needed,
                           const std::vector<int>& position)
{
  std::vector<PetscInt> rows;
  rows_.place.assign(is_needed.size(), -1);
  for (std::size_t row = 0; row < is_needed.size(); ++row) {
    if (is_needed[row] == 0) continue;
    rows_.place[row] = static_cast<int>(rows.size());
    rows.push_back(static_cast<PetscInt>(row));
  }
  if (petsc::size(petsc::communicator(A)) == 1)
    borrow(A);
  else
    gather(A, rows, position);
}

void GatheredRows::borrow(Mat A)
{
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  petsc::check(
      MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.starts, &rows_.columns, &done));
  if (!done) throw Error("supernodal: the matrix is not of type AIJ; convert it with MatConvert");
  petsc::check(MatSeqAIJGetArrayRead(A, &rows_.values));
  borrowed_ = A;
}

void GatheredRows::gather(Mat A, const std::vector<PetscInt>& rows,
                          const std::vector<int>& position)
{
  const MPI_Comm comm = petsc::communicator(A);
  const Received<PetscInt> asked = exchanged(by_owner(A, rows), MPIU_INT, comm);
  ByRank<PetscInt> lengths{.numbers = {}, .counts = asked.counts};
  ByRank<PetscInt> columns{.numbers = {}, .counts = {}};
  ByRank<PetscScalar> values;
  MatInfo own{};
  petsc::check(MatGetInfo(A, MAT_LOCAL, &own));
  const auto n_own = static_cast<std::size_t>(own.nz_used);
  columns.numbers.reserve(n_own);  // address space only: about half of it is used
  values.numbers.reserve(n_own);
  const PetscInt* row = asked.numbers.get();
  for (const int n_rows : asked.counts) {
    const std::size_t before = columns.numbers.size();
    for (const PetscInt* last = row + n_rows; row != last; ++row) {
      PetscInt n = 0, n_kept = 0;
      const PetscInt* row_columns = nullptr;
      const PetscScalar* row_values = nullptr;
      petsc::check(MatGetRow(A, *row, &n, &row_columns, &row_values));
      for (PetscInt k = 0; k < n; ++k) {
        if (position[row_columns[k]] < position[*row]) continue;
        columns.numbers.push_back(row_columns[k]);
        values.numbers.push_back(row_values[k]);
        ++n_kept;
      }
      petsc::check(MatRestoreRow(A, *row, &n, &row_columns, &row_values));
      lengths.numbers.push_back(n_kept);
    }
    columns.counts.push_back(static_cast<int>(columns.numbers.size() - before));
  }
  values.counts = columns.counts;
  const Received<PetscInt> of_rows = exchanged(lengths, MPIU_INT, comm);
  const std::span<const PetscInt> n_entries = of_rows.all();
  starts_.assign(n_entries.size() + 1, 0);
  std::inclusive_scan(n_entries.begin(), n_entries.end(), starts_.begin() + 1);
  columns_ = exchanged(columns, MPIU_INT, comm).numbers;
  values_ = exchanged(values, MPIU_SCALAR, comm).numbers;
  rows_.starts = starts_.data();
  rows_.columns = columns_.get();
  rows_.values = values_.get();
}

GatheredRows::~GatheredRows()
{
  if (borrowed_ == nullptr) return;
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  MatSeqAIJRestoreArrayRead(borrowed_, &rows_.values);
  MatRestoreRowIJ(borrowed_, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.starts, &rows_.columns, &done);
}

}  // namespace chladni::linear
