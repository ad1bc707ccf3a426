#include "linear/kernels/scratch.hpp"

#include <memory>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/growing_memory.hpp"
#include "linear/machine_memory.hpp"

namespace chladni::linear {

namespace {

PetscErrorCode give_back(void* memory)
{
  delete static_cast<GrowingMemory*>(memory);
  return 0;
}

/// The matrix has values of which it does not know that they must outlive it.
void keep_with(Mat dense, std::unique_ptr<GrowingMemory> memory)
{
  PetscContainer container = nullptr;
  petsc::check(PetscContainerCreate(petsc::communicator(dense), &container));
  petsc::check(PetscContainerSetPointer(container, memory.release()));
  petsc::check(PetscContainerSetUserDestroy(container, give_back));
  petsc::check(PetscObjectCompose(reinterpret_cast<PetscObject>(dense), "chladni_scratch",
                                  reinterpret_cast<PetscObject>(container)));
  petsc::check(PetscContainerDestroy(&container));
}

}  // namespace

petsc::Matrix large_dense(Mat A, PetscInt n_columns, const std::string& folder)
{
  if (folder.empty()) return uninitialized_dense(A, n_columns);
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  auto memory = std::make_unique<GrowingMemory>(folder);
  int refused = memory->grow(std::size_t(n_local) * n_columns) ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &refused, 1, MPI_INT, MPI_MAX, petsc::communicator(A));
  if (refused == 1) {
    throw Error(
        fmt::format("the folder {} for scratch files has no room for {:.0f} MiB; give "
                    "another one by -cms_scratch",
                    folder, sizeof(double) * double(n) * n_columns / bytes_in_MiB));
  }
  petsc::Matrix dense;
  petsc::check(MatCreateDense(petsc::communicator(A), n_local, PETSC_DECIDE, n, n_columns,
                              memory->get(), dense.put()));
  keep_with(dense, std::move(memory));
  return dense;
}

}  // namespace chladni::linear
