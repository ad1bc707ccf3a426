#include "linear/machine_memory.hpp"

#include <malloc.h>

#include <array>
#include <fstream>

#include "common/petsc.hpp"

namespace chladni::linear {

namespace {

double sum_on_machine(double own, MPI_Comm comm)
{
  double sum = own;
  MPI_Comm same_memory = MPI_COMM_NULL;
  MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &same_memory);
  MPI_Allreduce(&own, &sum, 1, MPI_DOUBLE, MPI_SUM, same_memory);
  MPI_Comm_free(&same_memory);
  return sum;
}

}  // namespace

double free_MiB()
{
  std::ifstream meminfo("/proc/meminfo");
  std::string name, unit;
  double KiB = 0.0;
  while (meminfo >> name >> KiB) {
    if (name == "MemAvailable:") return KiB / 1024.0;
    std::getline(meminfo, unit);
  }
  return std::numeric_limits<double>::infinity();
}

void give_back_freed()
{
  malloc_trim(0);
}

double freed_MiB()
{
  return static_cast<double>(mallinfo2().fordblks) / (1024.0 * 1024.0);
}

MemoryNeed tightest_machine(double own_MiB, double free_MiB, MPI_Comm comm)
{
  std::array<double, 2> need{sum_on_machine(own_MiB, comm), free_MiB};
  struct {
    double lacking;
    int rank;
  } here{need[0] - need[1], petsc::rank(comm)}, worst{};
  MPI_Allreduce(&here, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm);
  MPI_Bcast(need.data(), 2, MPI_DOUBLE, worst.rank, comm);
  return {.needed_MiB = need[0], .free_MiB = need[1]};
}

void require_memory(double own_MiB, const std::string& what, const std::string& cure, MPI_Comm comm)
{
  const MemoryNeed need = tightest_machine(own_MiB, free_MiB(), comm);
  if (need.fits()) return;
  throw Error(
      fmt::format("{} needs {:.0f} MiB more on one machine, and {:.0f} MiB are free there; {}",
                  what, need.needed_MiB, need.free_MiB, cure));
}

}  // namespace chladni::linear
