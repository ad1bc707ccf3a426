#include "linear/kernels/own_submatrix.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/index_sets.hpp"
#include "linear/kernels/as_aij.hpp"
#include "linear/kernels/scratch.hpp"
#include "linear/kernels/values_at.hpp"

namespace chladni::linear {

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
class Pieces {
 public:
  explicit Pieces(double* memory) : next_(reinterpret_cast<char*>(memory)) {}
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
  Pieces pieces(room->get());
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
  Pieces pieces(room->get());
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
