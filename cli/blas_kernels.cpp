#include "cli/blas_kernels.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

// OpenBLAS' own; its headers are not needed for it.
extern "C" char* openblas_get_corename();  // NOLINT(readability-identifier-naming)

namespace chladni::cli {
namespace {

/// The best kernels of OpenBLAS for this processor among those that matter, or none.
const char* fitting_kernels()
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    return "SkylakeX";
  }
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

}  // namespace

void restart_with_fitting_blas_kernels(char** argv)
{
  constexpr const char* variable = "OPENBLAS_CORETYPE";
  if (std::getenv(variable) != nullptr || !is_fallback(openblas_get_corename())) return;
  const char* kernels = fitting_kernels();
  if (kernels == nullptr || setenv(variable, kernels, 0) != 0) return;
  std::error_code ignored;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  execv(program.c_str(), argv);  // where that fails, the slow kernels do
}

}  // namespace chladni::cli
