#include "cases/ranks.hpp"

#include <mpi.h>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"

namespace chladni::cases {
namespace {

double reduce_over_ranks(double x, MPI_Op operation)
{
  double result = x;
  MPI_Allreduce(&x, &result, 1, MPI_DOUBLE, operation, PETSC_COMM_WORLD);
  return result;
}

}  // namespace

int rank()
{
  return petsc::rank(PETSC_COMM_WORLD);
}

int n_ranks()
{
  return petsc::size(PETSC_COMM_WORLD);
}

double sum_over_ranks(double x)
{
  return reduce_over_ranks(x, MPI_SUM);
}

double largest_of_ranks(double x)
{
  return reduce_over_ranks(x, MPI_MAX);
}

void on_first_rank(const std::function<void()>& work)
{
  chladni::on_first_rank(PETSC_COMM_WORLD, work);
}

}  // namespace chladni::cases
