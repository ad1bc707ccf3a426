#include "linear/kernels/scratch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "common/petsc_attached.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/machine_memory.hpp"

namespace chladni::linear {

void keep_with(Mat A, std::unique_ptr<GrowingMemory> memory)
{
  petsc::keep_with(reinterpret_cast<PetscObject>(A), "chladni_scratch", std::move(memory));
}

std::unique_ptr<GrowingMemory> room_for(double n_bytes, const std::string& folder, MPI_Comm comm)
{
  auto memory = std::make_unique<GrowingMemory>(folder);
  int lack = int(memory->grow(static_cast<std::size_t>(n_bytes / sizeof(double)) + 1));
  MPI_Allreduce(MPI_IN_PLACE, &lack, 1, MPI_INT, MPI_MAX, comm);
  MPI_Allreduce(MPI_IN_PLACE, &n_bytes, 1, MPI_DOUBLE, MPI_SUM, comm);
  if (Lack(lack) == Lack::none) return memory;
  throw Error(told(Lack(lack), fmt::format("{:.0f} MiB", std::ceil(n_bytes / bytes_in_MiB)),
                   "ask for fewer modes or masters", folder));
}

petsc::Matrix large_dense(Mat A, PetscInt n_columns, const std::string& folder)
{
  constexpr double worth_a_map = 1.0 * (1 << 20);
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  const double n_bytes = sizeof(double) * double(n_local) * n_columns;
  const double all_bytes = sizeof(double) * double(n) * n_columns;
  if (folder.empty() && all_bytes < worth_a_map) {
    petsc::Matrix small = uninitialized_dense(A, n_columns);
    petsc::check(MatZeroEntries(small));
    return small;
  }
  std::unique_ptr<GrowingMemory> memory = room_for(n_bytes, folder, petsc::communicator(A));
  memory->take_small_pages();
  petsc::Matrix dense;
  petsc::check(MatCreateDense(petsc::communicator(A), n_local, PETSC_DECIDE, n, n_columns,
                              memory->get(), dense.put()));
  keep_with(dense, std::move(memory));
  return dense;
}

}  // namespace chladni::linear
