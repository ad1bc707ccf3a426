#include "linear/kernels/scratch.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "common/petsc_attached.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/growing_memory.hpp"
#include "linear/machine_memory.hpp"

namespace chladni::linear {

namespace {

/// The matrix has arrays of which it does not know that they must outlive it.
void keep(Mat A, std::unique_ptr<GrowingMemory> file)
{
  petsc::keep_with(reinterpret_cast<PetscObject>(A), "chladni_scratch", std::move(file));
}

/// @throws chladni::Error on all ranks when one has no room.
std::unique_ptr<GrowingMemory> file_for(double n_bytes, const std::string& folder, MPI_Comm comm)
{
  auto memory = std::make_unique<GrowingMemory>(folder);
  int refused = memory->grow(static_cast<std::size_t>(n_bytes / sizeof(double)) + 1) ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &refused, 1, MPI_INT, MPI_MAX, comm);
  MPI_Allreduce(MPI_IN_PLACE, &n_bytes, 1, MPI_DOUBLE, MPI_SUM, comm);
  if (refused == 0) return memory;
  throw Error(
      fmt::format("the folder {} for scratch files has no room for {:.0f} MiB; give another one by "
                  "-cms_scratch",
                  folder, n_bytes / bytes_in_MiB));
}

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

  PetscInt n_rows() const { return n_rows_; }
  std::size_t n_entries() const { return std::size_t(starts_[n_rows_]); }
  double n_bytes() const
  {
    const double n = double(n_entries());
    return n * (sizeof(PetscScalar) + sizeof(PetscInt)) + sizeof(PetscInt) * (n_rows_ + 1.0);
  }
  std::span<const PetscInt> starts() const { return {starts_, std::size_t(n_rows_) + 1}; }
  std::span<const PetscInt> columns() const { return {columns_, n_entries()}; }
  std::span<const PetscScalar> values() const { return {values_, n_entries()}; }

 private:
  Mat A_;
  PetscInt n_rows_ = 0;
  const PetscInt *starts_ = nullptr, *columns_ = nullptr;
  const PetscScalar* values_ = nullptr;
};

/// Arrays one behind the other, those of widest numbers first.
class Copies {
 public:
  explicit Copies(double* memory) : next_(reinterpret_cast<char*>(memory)) {}
  template <typename T>
  T* of(std::span<const T> values)
  {
    T* copy = reinterpret_cast<T*>(next_);
    std::ranges::copy(values, copy);
    next_ += values.size_bytes();
    return copy;
  }

 private:
  char* next_;
};

petsc::Matrix sequential_in(const std::string& folder, Mat A)
{
  const Arrays from(A);
  std::unique_ptr<GrowingMemory> file = file_for(from.n_bytes(), folder, petsc::communicator(A));
  Copies copies(file->get());
  PetscScalar* values = copies.of(from.values());
  PetscInt* columns = copies.of(from.columns());
  PetscInt* starts = copies.of(from.starts());
  PetscInt n_columns = 0;
  petsc::check(MatGetSize(A, nullptr, &n_columns));
  petsc::Matrix moved;
  petsc::check(MatCreateSeqAIJWithArrays(petsc::communicator(A), from.n_rows(), n_columns, starts,
                                         columns, values, moved.put()));
  keep(moved, std::move(file));
  return moved;
}

petsc::Matrix distributed_in(const std::string& folder, Mat A)
{
  Mat own = nullptr, other = nullptr;
  const PetscInt* ghosts = nullptr;
  petsc::check(MatMPIAIJGetSeqAIJ(A, &own, &other, &ghosts));
  const Arrays diagonal(own), beside(other);
  std::unique_ptr<GrowingMemory> file =
      file_for(diagonal.n_bytes() + beside.n_bytes(), folder, petsc::communicator(A));
  Copies copies(file->get());
  PetscScalar* values = copies.of(diagonal.values());
  PetscScalar* other_values = copies.of(beside.values());
  PetscInt* columns = copies.of(diagonal.columns());
  PetscInt* other_columns = copies.of(beside.columns());
  for (std::size_t i = 0; i < beside.n_entries(); ++i) other_columns[i] = ghosts[other_columns[i]];
  PetscInt* starts = copies.of(diagonal.starts());
  PetscInt* other_starts = copies.of(beside.starts());
  PetscInt n_rows = 0, n_columns = 0, n_all_rows = 0, n_all_columns = 0;
  petsc::check(MatGetLocalSize(A, &n_rows, &n_columns));
  petsc::check(MatGetSize(A, &n_all_rows, &n_all_columns));
  petsc::Matrix moved;
  petsc::check(MatCreateMPIAIJWithSplitArrays(petsc::communicator(A), n_rows, n_columns, n_all_rows,
                                              n_all_columns, starts, columns, values, other_starts,
                                              other_columns, other_values, moved.put()));
  keep(moved, std::move(file));
  return moved;
}

}  // namespace

petsc::Matrix large_dense(Mat A, PetscInt n_columns, const std::string& folder)
{
  if (folder.empty()) return uninitialized_dense(A, n_columns);
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  std::unique_ptr<GrowingMemory> file =
      file_for(sizeof(double) * double(n_local) * n_columns, folder, petsc::communicator(A));
  petsc::Matrix dense;
  petsc::check(MatCreateDense(petsc::communicator(A), n_local, PETSC_DECIDE, n, n_columns,
                              file->get(), dense.put()));
  keep(dense, std::move(file));
  return dense;
}

petsc::Matrix moved_to_scratch(petsc::Matrix A, const std::string& folder)
{
  if (folder.empty()) return A;
  const auto object = reinterpret_cast<PetscObject>(Mat(A));
  PetscBool is_sequential = PETSC_FALSE, is_distributed = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare(object, MATSEQAIJ, &is_sequential));
  petsc::check(PetscObjectTypeCompare(object, MATMPIAIJ, &is_distributed));
  if (is_sequential == PETSC_FALSE && is_distributed == PETSC_FALSE) return A;
  petsc::Matrix moved = is_sequential ? sequential_in(folder, A) : distributed_in(folder, A);
  PetscInt block_size = 1;
  petsc::check(MatGetBlockSize(A, &block_size));
  petsc::check(MatSetBlockSize(moved, block_size));
  petsc::check(MatPropagateSymmetryOptions(A, moved));
  return moved;
}

}  // namespace chladni::linear
