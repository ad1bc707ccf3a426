#include "linear/kernels/values_at.hpp"

namespace chladni::linear {

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

}  // namespace chladni::linear
