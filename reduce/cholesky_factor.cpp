#include "reduce/cholesky_factor.hpp"

namespace chladni::reduce {

double fullest_machine(double own, MPI_Comm comm)
{
  double machine = own, fullest = 0.0;
  MPI_Comm same_memory = MPI_COMM_NULL;
  MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &same_memory);
  MPI_Allreduce(&own, &machine, 1, MPI_DOUBLE, MPI_SUM, same_memory);
  MPI_Comm_free(&same_memory);
  MPI_Allreduce(&machine, &fullest, 1, MPI_DOUBLE, MPI_MAX, comm);
  return fullest;
}

}  // namespace chladni::reduce
