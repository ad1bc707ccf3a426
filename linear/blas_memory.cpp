#include "linear/blas_memory.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>

// OpenBLAS' own; its headers are not needed for them.
extern "C" int openblas_get_num_threads();  // NOLINT(readability-identifier-naming)
extern "C" void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k,
                       const double* alpha, const double* a, const int* lda, const double* beta,
                       double* c, const int* ldc);  // NOLINT(readability-identifier-naming)

namespace chladni::linear {
namespace {

constexpr std::size_t MiB = 1 << 20;
constexpr std::size_t buffer = 128 * MiB;        // of each thread, in Debian's OpenBLAS
constexpr std::size_t start_of_mpi = 192 * MiB;  // MPI and PETSc, which crash where it is lacking

/// Buffers that the threads have got by now: large pieces of memory without a file.
std::size_t n_buffers_there()
{
  std::size_t n = 0;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::size_t begin = 0, end = 0, inode = 1;
    char dash = ' ';
    std::string access, offset, device;
    words >> std::hex >> begin >> dash >> end >> access >> offset >> device >> std::dec >> inode;
    if (inode == 0 && access == "rw-p") n += (end - begin) / buffer;
  }
  return n;
}

bool fits(std::size_t size)
{
  void* there = mmap(nullptr, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (there == MAP_FAILED) return false;
  munmap(there, size);
  return true;
}

/// The first call takes the buffer of this thread, before others take the memory.
void take_own_buffer()
{
  const int one = 1;
  const double factor = 1.0;
  double value = 0.0;
  dsyrk_("U", "N", &one, &one, &factor, &value, &one, &factor, &value, &one);
}

}  // namespace

std::string lacking_addresses()
{
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  const std::size_t n_threads = std::max(1, openblas_get_num_threads());
  const std::size_t lacking = n_threads - std::min(n_threads, n_buffers_there());
  if (fits(lacking * buffer + start_of_mpi)) {
    take_own_buffer();
    return {};
  }
  return fmt::format(
      "the limit of this shell (ulimit -v, {} MiB of addresses) is too low to begin with: "
      "{} of {} threads of OpenBLAS lack {} MiB each, MPI and PETSc need {} MiB; raise it, or "
      "set OPENBLAS_NUM_THREADS=1",
      limit.rlim_cur / MiB, lacking, n_threads, buffer / MiB, start_of_mpi / MiB);
}

}  // namespace chladni::linear
