#include "common/files/trial_reading.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <system_error>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/files/hdf5_objects.hpp"

namespace chladni::files {
namespace {

constexpr std::uint64_t MiB = std::uint64_t{1} << 20;

/// What a walk through all objects carries with it.
struct Walk {
  hsize_t file_size;
  std::unique_ptr<char[]> values = {};  ///< of one dataset after the other
  std::size_t size = 0;                 ///< of `values`, bytes
  std::string refusal = {};
};

herr_t read_attribute(hid_t object, const char* name, const H5A_info_t* /*info*/, void* walk)
{
  const Handle attribute{H5Aopen(object, name, H5P_DEFAULT), H5Aclose};
  if (!attribute.valid()) return 0;
  const Handle type{H5Aget_type(attribute.get()), H5Tclose},
      space{H5Aget_space(attribute.get()), H5Sclose};
  const std::size_t size = H5Tget_size(type.get());
  if (H5Sget_simple_extent_npoints(space.get()) != 1 || size == 0 ||
      size > static_cast<Walk*>(walk)->file_size)
    return 0;
  std::vector<char> value(std::max(size, sizeof(std::int64_t)));
  if (H5Tget_class(type.get()) == H5T_INTEGER)
    H5Aread(attribute.get(), H5T_NATIVE_INT64, value.data());
  if (H5Tget_class(type.get()) == H5T_STRING && H5Tis_variable_str(type.get()) == 0)
    H5Aread(attribute.get(), type.get(), value.data());
  return 0;
}

/// Reads a dataset unless Reader would refuse it by name.
void read_dataset(Handle id, hid_t creation, Walk& walk)
{
  std::optional<Handle> type = memory_type(id.get());
  const auto shape = plausible_shape(id.get(), creation, walk.file_size);
  if (!type || !shape) return;
  const Dataset dataset{std::move(id), *shape, std::move(*type)};
  const std::size_t n = dataset.n_bytes();
  if (n == 0 || n > most_memory(walk.file_size)) return;
  if (n > walk.size) {
    walk.values.reset();
    walk.values = std::make_unique_for_overwrite<char[]>(n);
    walk.size = n;
  }
  read_values(dataset, walk.values.get());
}

herr_t read_object(hid_t file, const char* name, const H5O_info_t* info, void* to_walk)
{
  Walk& walk = *static_cast<Walk*>(to_walk);
  Handle object{H5Oopen(file, name, H5P_DEFAULT), H5Oclose};
  if (!object.valid()) return 0;
  H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, read_attribute, &walk);
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle creation{H5Dget_create_plist(object.get()), H5Pclose};
  if (const std::string why = foreign_part(creation.get()); !why.empty()) {
    walk.refusal = fmt::format("{}: {}", shown(name), why);
    return 1;
  }
  if (!is_view(creation.get())) read_dataset(std::move(object), creation.get(), walk);
  return 0;
}

/// @return why it is not to be read; empty where there is no reason
std::string read_everything(const std::string& path)
{
  const Handle file{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!file.valid()) return "";
  if (std::string link = foreign_link(file.get()); !link.empty()) return link;
  std::error_code unknown;
  Walk walk{.file_size = std::filesystem::file_size(path, unknown)};
  visit_objects(file.get(), H5_ITER_NATIVE, read_object, &walk);
  return walk.refusal;
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
std::uint64_t peak_memory()
{
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return std::uint64_t(used.ru_maxrss) * 1024;
}

/// Others' handlers of signals are not for this process, nor what malloc or a sanitizer says.
void leave_the_program()
{
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGALRM})
    std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
}

std::string too_much_memory(const TrialLimits& limits)
{
  return fmt::format("unpacks to more than {} MiB, 16 times its size and 128 MiB, and is not read",
                     limits.memory / MiB);
}

/// Never returns. Its verdict is a '+', or a '-' and why not.
[[noreturn]] void try_reading(const std::string& path, const TrialLimits& limits, int verdict)
{
  leave_the_program();
  const std::uint64_t before = peak_memory();
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, limits.cpu_s);
  lower(RLIMIT_AS, size_of_process() + 2 * limits.memory);
  alarm(limits.wall_s);
  std::string refusal;
  try {
    refusal = read_everything(path);
  } catch (const std::bad_alloc&) {
    refusal = too_much_memory(limits);
  } catch (...) {
    _exit(1);
  }
  // Memory that ran out is an error in order for libhdf5, and would not be with all of the
  // machine's.
  if (peak_memory() > before + limits.memory) refusal = too_much_memory(limits);
  const std::string said = refusal.empty() ? "+" : "-" + refusal;
  _exit(write(verdict, said.data(), said.size()) == ssize_t(said.size()) ? 0 : 1);
}

/// All that comes out of a pipe; closes it.
std::string all_of(int pipe)
{
  std::string text;
  std::array<char, 4096> piece{};
  for (;;) {
    const ssize_t n = read(pipe, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    text.append(piece.data(), std::size_t(n));
  }
  close(pipe);
  return text;
}

/// How a process ended that gave no verdict.
std::string describe_end(pid_t child, const TrialLimits& limits)
{
  int status = 0;
  pid_t ended = -1;
  do {
    ended = waitpid(child, &status, 0);
  } while (ended < 0 && errno == EINTR);
  const bool in_time = ended < 0 || !WIFSIGNALED(status) ||
                       (WTERMSIG(status) != SIGALRM && WTERMSIG(status) != SIGXCPU);
  if (in_time) return "is so damaged that libhdf5 ends over it; make it anew or take a copy";
  return fmt::format(
      "takes more than {} s of the processor or {} s on the clock to read; make it anew or take a "
      "copy",
      limits.cpu_s, limits.wall_s);
}

}  // namespace

TrialLimits limits_of_trial(std::uint64_t file_size)
{
  return {.memory = most_memory(file_size),
          .cpu_s = unsigned(10 + file_size / (10 * MiB)),
          .wall_s = unsigned(60 + file_size / MiB)};
}

std::optional<std::string> refusal_of_trial(const std::string& path, const TrialLimits& limits)
{
  prepare_to_read();
  std::array<int, 2> ends{-1, -1};
  const pid_t child = pipe2(ends.data(), O_CLOEXEC) == 0 ? fork() : -1;
  if (child == 0) try_reading(path, limits, ends[1]);
  const int why = errno;
  close(ends[1]);
  const std::string verdict = all_of(ends[0]);
  if (child < 0) {
    throw Error(fmt::format("{}: cannot start the process that tests a file before it is read: {}",
                            path, std::strerror(why)));
  }
  const std::string end = describe_end(child, limits);
  if (verdict == "+") return std::nullopt;
  return verdict.starts_with('-') ? verdict.substr(1) : end;
}

}  // namespace chladni::files
