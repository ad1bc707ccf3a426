#include "files/trial_reading.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <vector>

#include "files/hdf5_handle.hpp"

namespace chladni::files {
namespace {

constexpr std::uintmax_t MiB = 1024 * 1024;

/// Bytes of the values; 0 for those that Reader takes from no file: more than a compressed file can
/// hold, or of variable length.
std::size_t size_of_values(hid_t type, hid_t space, hsize_t stored)
{
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  const std::size_t size = H5Tget_size(type);
  const bool is_variable = H5Tis_variable_str(type) != 0 || H5Tdetect_class(type, H5T_VLEN) != 0;
  if (n <= 0 || size == 0 || is_variable || stored > hsize_t(-1) / 1024) return 0;
  return hsize_t(n) <= 1024 * stored / size ? static_cast<std::size_t>(n) * size : 0;
}

herr_t read_attribute(hid_t object, const char* name, const H5A_info_t*, void* file_size)
{
  const Handle attribute{H5Aopen(object, name, H5P_DEFAULT), H5Aclose};
  if (!attribute.valid()) return 0;
  const Handle type{H5Aget_type(attribute.get()), H5Tclose},
      space{H5Aget_space(attribute.get()), H5Sclose};
  std::vector<char> values(
      size_of_values(type.get(), space.get(), *static_cast<hsize_t*>(file_size)));
  if (!values.empty()) H5Aread(attribute.get(), type.get(), values.data());
  return 0;
}

void read_dataset(hid_t dataset, hsize_t file_size)
{
  const Handle type{H5Dget_type(dataset), H5Tclose}, space{H5Dget_space(dataset), H5Sclose};
  const hsize_t stored = std::min<hsize_t>(H5Dget_storage_size(dataset), file_size);
  std::vector<char> values(size_of_values(type.get(), space.get(), stored));
  if (!values.empty()) H5Dread(dataset, type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

herr_t read_object(hid_t file, const char* name, const H5O_info_t* info, void* file_size)
{
  const Handle object{H5Oopen(file, name, H5P_DEFAULT), H5Oclose};
  if (!object.valid()) return 0;
  H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, read_attribute, file_size);
  if (info->type == H5O_TYPE_DATASET) read_dataset(object.get(), *static_cast<hsize_t*>(file_size));
  return 0;
}

void read_everything(const std::string& path, hsize_t file_size)
{
  silence_errors();
  const Handle file{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (file.valid())
    H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_NATIVE, read_object, &file_size, H5O_INFO_BASIC);
}

/// Of this process, bytes.
rlim_t size_of_process()
{
  rlim_t n_pages = 0;
  std::ifstream("/proc/self/statm") >> n_pages;
  return n_pages * rlim_t(sysconf(_SC_PAGESIZE));
}

void lower(__rlimit_resource resource, rlim_t limit)
{
  const rlimit limits{limit, limit};
  setrlimit(resource, &limits);
}

/// The most that this process has held in memory, bytes.
std::uintmax_t peak_memory()
{
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return std::uintmax_t(used.ru_maxrss) * 1024;
}

/// Never returns: others' handlers of signals and their exit are not for this process.
[[noreturn]] void try_reading(const std::string& path, std::uintmax_t file_size)
{
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
    std::signal(number, SIG_DFL);
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);  // what malloc or a sanitizer says
  const std::uintmax_t fitting = 128 * MiB + 16 * file_size, before = peak_memory();
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, 10 + file_size / (10 * MiB));
  lower(RLIMIT_AS, size_of_process() + 2 * fitting);
  try {
    read_everything(path, file_size);
  } catch (...) {
    _exit(1);
  }
  // Memory that ran out is an error in order for libhdf5, and would not be with all of the
  // machine's.
  _exit(peak_memory() > before + fitting ? 1 : 0);
}

}  // namespace

bool survives_reading(const std::string& path)
{
  const std::uintmax_t file_size = std::filesystem::file_size(path);
  const pid_t child = fork();
  if (child == 0) try_reading(path, file_size);
  int status = 0;
  pid_t ended = -1;
  do {
    ended = child < 0 ? -1 : waitpid(child, &status, 0);
  } while (ended < 0 && child > 0 && errno == EINTR);
  return ended < 0 || (WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace chladni::files
