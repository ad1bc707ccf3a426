#include "linear/blas_kernels.hpp"

#include <dlfcn.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <thread>

// OpenBLAS' own; its headers are not needed for them.
extern "C" char* openblas_get_corename();       // NOLINT(readability-identifier-naming)
extern "C" void openblas_set_num_threads(int);  // NOLINT(readability-identifier-naming)

namespace chladni::linear {
namespace {

/// The best kernels of OpenBLAS for this processor among those that matter, or none.
const char* fitting_kernels()
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

/// The kernels that OpenBLAS falls back to when it does not know the processor.
bool is_fallback(std::string_view kernels)
{
  return kernels == "Prescott" || kernels == "Core2" || kernels == "Nehalem" ||
         kernels == "unknown";
}

/// Has OpenBLAS read OPENBLAS_CORETYPE once more, which is ten times as fast as to load all
/// libraries again; whether it could.
bool chooses_anew()
{
  using Step = void (*)();
  const auto end = reinterpret_cast<Step>(dlsym(RTLD_DEFAULT, "gotoblas_dynamic_quit"));
  const auto begin = reinterpret_cast<Step>(dlsym(RTLD_DEFAULT, "gotoblas_dynamic_init"));
  if (end == nullptr || begin == nullptr) return false;
  end();
  begin();
  return !is_fallback(openblas_get_corename());
}

}  // namespace

void take_fitting_blas_kernels(char** argv)
{
  constexpr const char* variable = "OPENBLAS_CORETYPE";
  if (std::getenv(variable) != nullptr || !is_fallback(openblas_get_corename())) return;
  const char* kernels = fitting_kernels();
  if (kernels == nullptr || setenv(variable, kernels, 0) != 0 || chooses_anew()) return;
  std::error_code ignored;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  execv(program.c_str(), argv);  // where that fails, the slow kernels do
}

void share_processors()
{
  for (const char* variable : {"OPENBLAS_NUM_THREADS", "GOTO_NUM_THREADS", "OMP_NUM_THREADS"})
    if (std::getenv(variable) != nullptr) return;
  MPI_Comm machine = MPI_COMM_NULL;
  int n_ranks = 1;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &n_ranks);
  MPI_Comm_free(&machine);
  const int n_processors = static_cast<int>(std::thread::hardware_concurrency());
  openblas_set_num_threads(std::max(1, n_processors / n_ranks));
}

}  // namespace chladni::linear
