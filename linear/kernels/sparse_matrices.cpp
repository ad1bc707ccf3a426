#include "linear/kernels/sparse_matrices.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/storage.hpp"

namespace chladni::linear {

petsc::Matrix as_aij(Mat A)
{
  const auto object = reinterpret_cast<PetscObject>(A);
  PetscBool is_plain = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompareAny(object, &is_plain, MATSEQAIJ, MATMPIAIJ, ""));
  if (is_plain) {
    petsc::check(PetscObjectReference(object));
    return petsc::Matrix(A);
  }
  petsc::Matrix copy;
  petsc::check(MatConvert(A, MATAIJ, MAT_INITIAL_MATRIX, copy.put()));
  return copy;
}

petsc::Matrix with_ascending_rows(petsc::Matrix A)
{
  PetscInt before_row = -1, before_column = -1, n_local = 0, n = 0, first = 0;
  int is_unsorted = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  std::vector<PetscInt> n_in_row(std::size_t(n_local), 0);
  for_local_entries(A, [&](PetscInt row, PetscInt column, double) {
    if (row == before_row && column <= before_column) is_unsorted = 1;
    before_row = row;
    before_column = column;
    ++n_in_row[std::size_t(row - first)];
  });
  const MPI_Comm comm = petsc::communicator(A);
  MPI_Allreduce(MPI_IN_PLACE, &is_unsorted, 1, MPI_INT, MPI_MAX, comm);
  if (is_unsorted == 0) return A;
  petsc::Matrix sum;
  // Each row may stand in the part of this rank or in that of others.
  petsc::check(MatCreateAIJ(comm, n_local, n_local, n, n, 0, n_in_row.data(), 0, n_in_row.data(),
                            sum.put()));
  for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    petsc::check(MatSetValue(sum, row, column, value, ADD_VALUES));
  });
  petsc::check(MatAssemblyBegin(sum, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(sum, MAT_FINAL_ASSEMBLY));
  return sum;
}

namespace {

bool is_of_type(Mat A, MatType type)
{
  PetscBool is = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(A), type, &is));
  return is == PETSC_TRUE;
}

/// What holds the diagonal of this rank's rows, or null where that is no sequential AIJ matrix.
Mat sequential_part(Mat A)
{
  Mat own = A;
  if (is_of_type(A, MATMPIAIJ)) petsc::check(MatGetDiagonalBlock(A, &own));
  return is_of_type(own, MATSEQAIJ) ? own : nullptr;
}

/// @return false where some row has no entry there, or it is not found since the row is not in
/// order
bool read_diagonal(Mat own, PetscScalar* diagonal)
{
  PetscInt n = 0;
  const PetscInt *starts = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetRowIJ(own, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts, &columns, &done));
  petsc::check(MatSeqAIJGetArrayRead(own, &values));
  bool has_all = done == PETSC_TRUE;
  for (PetscInt i = 0; i < n && has_all; ++i) {
    const PetscInt* end = columns + starts[i + 1];
    const PetscInt* found = std::lower_bound(columns + starts[i], end, i);
    has_all = found != end && *found == i;
    if (has_all) diagonal[i] = values[found - columns];
  }
  petsc::check(MatSeqAIJRestoreArrayRead(own, &values));
  petsc::check(MatRestoreRowIJ(own, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts, &columns, &done));
  return has_all;
}

}  // namespace

petsc::Vector diagonal(Mat A)
{
  petsc::Vector d;
  petsc::check(MatCreateVecs(A, nullptr, d.put()));
  int has_all = 0;
  if (Mat own = sequential_part(A); own != nullptr) {
    PetscScalar* values = nullptr;
    petsc::check(VecGetArrayWrite(d, &values));
    has_all = read_diagonal(own, values) ? 1 : 0;
    petsc::check(VecRestoreArrayWrite(d, &values));
  }
  MPI_Allreduce(MPI_IN_PLACE, &has_all, 1, MPI_INT, MPI_MIN, petsc::communicator(A));
  if (has_all == 0) petsc::check(MatGetDiagonal(A, d));
  return d;
}

namespace {

bool is_sequential_aij(Mat A)
{
  PetscBool is = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(A), MATSEQAIJ, &is));
  return is == PETSC_TRUE;
}

/// Adds `factor` B to A where the pattern of A has that of B; false where it has not, and A is then
/// spoilt. PETSc inserts entry by entry.
bool add_within_pattern(Mat A, double factor, Mat B)
{
  PetscInt n = 0;
  const PetscInt *starts_A = nullptr, *columns_A = nullptr, *starts_B = nullptr,
                 *columns_B = nullptr;
  PetscBool has_A = PETSC_FALSE, has_B = PETSC_FALSE;
  PetscScalar* to = nullptr;
  const PetscScalar* from = nullptr;
  petsc::check(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_A, &columns_A, &has_A));
  petsc::check(MatGetRowIJ(B, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_B, &columns_B, &has_B));
  petsc::check(MatSeqAIJGetArray(A, &to));
  petsc::check(MatSeqAIJGetArrayRead(B, &from));
  bool is_within = has_A == PETSC_TRUE && has_B == PETSC_TRUE;
  for (PetscInt row = 0; row < n && is_within; ++row) {
    PetscInt at = starts_A[row];
    for (PetscInt k = starts_B[row]; k < starts_B[row + 1] && is_within; ++k) {
      while (at < starts_A[row + 1] && columns_A[at] < columns_B[k]) ++at;
      is_within = at < starts_A[row + 1] && columns_A[at] == columns_B[k];
      if (is_within) to[at] += factor * from[k];
    }
  }
  petsc::check(MatSeqAIJRestoreArrayRead(B, &from));
  petsc::check(MatSeqAIJRestoreArray(A, &to));
  petsc::check(MatRestoreRowIJ(B, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_B, &columns_B, &has_B));
  petsc::check(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_A, &columns_A, &has_A));
  return is_within;
}

petsc::Matrix copy_of(Mat A)
{
  petsc::Matrix copy;
  petsc::check(MatDuplicate(A, MAT_COPY_VALUES, copy.put()));
  return copy;
}

/// A + factor B
petsc::Matrix sum(Mat A, double factor, Mat B)
{
  if (is_sequential_aij(A) && is_sequential_aij(B)) {
    petsc::Matrix C = copy_of(A);
    if (add_within_pattern(C, factor, B)) return C;
  }
  petsc::Matrix C = copy_of(A);
  petsc::check(MatAXPY(C, factor, B, DIFFERENT_NONZERO_PATTERN));
  return C;
}

}  // namespace

petsc::Matrix shifted(Mat K, Mat M, double sigma)
{
  petsc::Matrix A = sum(K, -sigma, M);
  petsc::check(MatSetOption(A, MAT_SPD, PETSC_FALSE));  // K_ss is marked definite, A is not
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  return A;
}

namespace {

using Scatter = petsc::Owned<VecScatter, VecScatterDestroy>;

}  // namespace

std::vector<double> values_at(const std::vector<PetscInt>& rows, std::vector<double> own,
                              MPI_Comm comm)
{
  petsc::Vector all, wanted;
  petsc::IndexSet from;
  Scatter scatter;
  std::vector<double> values(rows.size());
  const auto n = static_cast<PetscInt>(rows.size());
  petsc::check(VecCreateMPIWithArray(comm, 1, static_cast<PetscInt>(own.size()), PETSC_DETERMINE,
                                     own.data(), all.put()));
  petsc::check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, values.data(), wanted.put()));
  petsc::check(ISCreateGeneral(PETSC_COMM_SELF, n, rows.data(), PETSC_USE_POINTER, from.put()));
  petsc::check(VecScatterCreate(all, from, wanted, nullptr, scatter.put()));
  petsc::check(VecScatterBegin(scatter, all, wanted, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterEnd(scatter, all, wanted, INSERT_VALUES, SCATTER_FORWARD));
  return values;
}

namespace {

constexpr PetscInt dropped = -1;

/// The arrays of a sequential AIJ matrix, borrowed.
class Arrays {
 public:
  explicit Arrays(Mat A) : A_(A)
  {
    PetscBool done = PETSC_FALSE;
    petsc::check(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n_rows_, &starts_, &columns_, &done));
    petsc::check(MatSeqAIJGetArrayRead(A, &values_));
  }
  ~Arrays()
  {
    PetscBool done = PETSC_FALSE;
    MatSeqAIJRestoreArrayRead(A_, &values_);
    MatRestoreRowIJ(A_, 0, PETSC_FALSE, PETSC_FALSE, &n_rows_, &starts_, &columns_, &done);
  }
  Arrays(const Arrays&) = delete;
  Arrays& operator=(const Arrays&) = delete;

  std::span<const PetscInt> columns(PetscInt row) const
  {
    return {columns_ + starts_[row], columns_ + starts_[row + 1]};
  }
  const PetscScalar* values(PetscInt row) const { return values_ + starts_[row]; }

 private:
  Mat A_;
  PetscInt n_rows_ = 0;
  const PetscInt *starts_ = nullptr, *columns_ = nullptr;
  const PetscScalar* values_ = nullptr;
};

/// Which entries of a row are kept, by their new columns. Rows that follow one another have often
/// the same columns.
class RowOrder {
 public:
  /// @param place  [columns] new number of each, or `dropped`
  explicit RowOrder(std::span<const PetscInt> place) : place_(place) {}

  /// New column and place in the row of each entry, ascending.
  std::span<const std::pair<PetscInt, PetscInt>> of(std::span<const PetscInt> columns)
  {
    if (!entries_.empty() && std::ranges::equal(columns, columns_)) return entries_;
    columns_ = columns;
    entries_.clear();
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const PetscInt place = place_[std::size_t(columns[k])];
      if (place != dropped) entries_.emplace_back(place, static_cast<PetscInt>(k));
    }
    if (!std::ranges::is_sorted(entries_)) std::ranges::sort(entries_);
    return entries_;
  }

 private:
  std::span<const PetscInt> place_, columns_;
  std::vector<std::pair<PetscInt, PetscInt>> entries_;
};

/// Some rows of a sequential matrix, that have entries in some columns.
class Selection {
 public:
  Selection(Mat A, const std::vector<PetscInt>& rows, std::vector<PetscInt> place)
      : from_(A), rows_(rows), place_(std::move(place))
  {
    for (const PetscInt row : rows) {
      n_entries_ += std::size_t(std::ranges::count_if(from_.columns(row), [&](PetscInt column) {
        return place_[std::size_t(column)] != dropped;
      }));
    }
  }

  double n_bytes() const
  {
    return double(n_entries_) * (sizeof(PetscScalar) + sizeof(PetscInt)) +
           sizeof(PetscInt) * (double(rows_.size()) + 1.0);
  }
  std::size_t n_entries() const { return n_entries_; }

  struct Target {
    PetscScalar* values;
    PetscInt *columns, *starts;
  };
  void write(const Target& to) const
  {
    RowOrder order(place_);
    PetscInt n = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      to.starts[i] = n;
      const PetscScalar* values = from_.values(rows_[i]);
      for (const auto& [column, k] : order.of(from_.columns(rows_[i]))) {
        to.columns[n] = column;
        to.values[n++] = values[k];
      }
    }
    to.starts[rows_.size()] = n;
  }

 private:
  Arrays from_;
  const std::vector<PetscInt>& rows_;
  std::vector<PetscInt> place_;
  std::size_t n_entries_ = 0;
};

/// Parts one behind the other of a piece of memory, those of widest numbers first.
class MemoryPieces {
 public:
  explicit MemoryPieces(double* memory) : next_(reinterpret_cast<char*>(memory)) {}
  template <typename T>
  T* of(std::size_t n)
  {
    T* piece = reinterpret_cast<T*>(next_);
    next_ += n * sizeof(T);
    return piece;
  }

 private:
  char* next_;
};

/// New numbers of the columns of this rank, counted on it.
std::vector<PetscInt> own_places(Mat A, IS columns)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRangeColumn(A, &first, &last));
  std::vector<PetscInt> place(std::size_t(last - first), dropped);
  PetscInt next = 0;
  for (const PetscInt column : petsc::own_indices(columns))
    place[std::size_t(column - first)] = next++;
  return place;
}

/// New global numbers of columns of other ranks.
std::vector<PetscInt> ghost_places(const std::vector<PetscInt>& own, IS columns,
                                   std::span<const PetscInt> ghosts)
{
  const PetscInt before = petsc::indices_before(columns);
  std::vector<double> numbers;
  for (const PetscInt place : own)
    numbers.push_back(place == dropped ? dropped : double(before) + place);
  const std::vector<double> found =
      values_at({ghosts.begin(), ghosts.end()}, std::move(numbers), petsc::communicator(columns));
  return {found.begin(), found.end()};
}

struct Layout {
  PetscInt n_rows = 0, n_columns = 0;          ///< of this rank
  PetscInt n_all_rows = 0, n_all_columns = 0;  ///< of all
  Layout(IS rows, IS columns)
  {
    petsc::check(ISGetLocalSize(rows, &n_rows));
    petsc::check(ISGetLocalSize(columns, &n_columns));
    petsc::check(ISGetSize(rows, &n_all_rows));
    petsc::check(ISGetSize(columns, &n_all_columns));
  }
};

petsc::Matrix sequential(Mat A, IS rows, IS columns, const std::string& folder)
{
  const Layout layout(rows, columns);
  const std::vector<PetscInt> own_rows = petsc::own_rows(rows, A);
  const Selection some(A, own_rows, own_places(A, columns));
  std::unique_ptr<GrowingMemory> room = room_for(some.n_bytes(), folder, petsc::communicator(A));
  MemoryPieces pieces(room->get());
  const Selection::Target to{.values = pieces.of<PetscScalar>(some.n_entries()),
                             .columns = pieces.of<PetscInt>(some.n_entries()),
                             .starts = pieces.of<PetscInt>(own_rows.size() + 1)};
  some.write(to);
  petsc::Matrix block;
  petsc::check(MatCreateSeqAIJWithArrays(petsc::communicator(A), layout.n_rows, layout.n_columns,
                                         to.starts, to.columns, to.values, block.put()));
  keep_with(block, std::move(room));
  return block;
}

petsc::Matrix distributed(Mat A, IS rows, IS columns, const std::string& folder)
{
  Mat own = nullptr, other = nullptr;
  const PetscInt* ghosts = nullptr;
  PetscInt n_ghosts = 0;
  petsc::check(MatMPIAIJGetSeqAIJ(A, &own, &other, &ghosts));
  petsc::check(MatGetSize(other, nullptr, &n_ghosts));
  const Layout layout(rows, columns);
  const std::vector<PetscInt> own_rows = petsc::own_rows(rows, A);
  const std::vector<PetscInt> places = own_places(A, columns);
  const Selection here(own, own_rows, places);
  const Selection beside(other, own_rows,
                         ghost_places(places, columns, {ghosts, std::size_t(n_ghosts)}));
  std::unique_ptr<GrowingMemory> room =
      room_for(here.n_bytes() + beside.n_bytes(), folder, petsc::communicator(A));
  MemoryPieces pieces(room->get());
  Selection::Target to{}, to_beside{};
  to.values = pieces.of<PetscScalar>(here.n_entries());
  to_beside.values = pieces.of<PetscScalar>(beside.n_entries());
  to.columns = pieces.of<PetscInt>(here.n_entries());
  to_beside.columns = pieces.of<PetscInt>(beside.n_entries());
  to.starts = pieces.of<PetscInt>(own_rows.size() + 1);
  to_beside.starts = pieces.of<PetscInt>(own_rows.size() + 1);
  here.write(to);
  beside.write(to_beside);
  petsc::Matrix block;
  petsc::check(MatCreateMPIAIJWithSplitArrays(
      petsc::communicator(A), layout.n_rows, layout.n_columns, layout.n_all_rows,
      layout.n_all_columns, to.starts, to.columns, to.values, to_beside.starts, to_beside.columns,
      to_beside.values, block.put()));
  keep_with(block, std::move(room));
  return block;
}

}  // namespace

petsc::Matrix own_submatrix(Mat A, IS rows, IS columns, const std::string& folder)
{
  const petsc::Matrix aij = as_aij(A);
  PetscBool is_sequential = PETSC_FALSE;
  petsc::check(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(Mat(aij)), MATSEQAIJ, &is_sequential));
  petsc::Matrix block = is_sequential ? sequential(aij, rows, columns, folder)
                                      : distributed(aij, rows, columns, folder);
  PetscInt block_rows = 1, block_columns = 1;
  petsc::check(ISGetBlockSize(rows, &block_rows));
  petsc::check(ISGetBlockSize(columns, &block_columns));
  petsc::check(MatSetBlockSizes(block, block_rows, block_columns));
  if (rows == columns) petsc::check(MatPropagateSymmetryOptions(A, block));
  return block;
}

}  // namespace chladni::linear
