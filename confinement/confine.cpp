#include "confinement/confine.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <new>

#include "confinement/errand.hpp"
#include "confinement/system_calls.hpp"

namespace chladni::confinement {
namespace {

/// The addresses of this process, bytes. A signal's handler may call it.
std::uint64_t size_of_process()
{
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  std::array<char, 32> text{};
  const ssize_t n_read = ::read(file, text.data(), text.size());
  ::close(file);
  std::uint64_t n_pages = 0;
  for (ssize_t i = 0; i < n_read && text[i] >= '0' && text[i] <= '9'; ++i)
    n_pages = 10 * n_pages + std::uint64_t(text[i] - '0');
  return n_pages * std::uint64_t(sysconf(_SC_PAGESIZE));
}

/// From how many bytes on a crash is taken for one of memory that ran out.
std::uint64_t suspicious_size = 0;
struct sigaction earlier_action {};

void judge_crash(int /*signal*/)
{
  if (size_of_process() > suspicious_size) _exit(exit_out_of_memory);
  sigaction(SIGSEGV, &earlier_action, nullptr);  // and the fault comes again
}

/// A C library that does not look at what malloc answers crashes where a C++ library ends by the
/// handler of `new`. The request that failed may have been large, so half of the limit is enough
/// to suspect it.
void watch_crashes(std::uint64_t size, std::uint64_t limit)
{
  suspicious_size = size + limit / 2;
  struct sigaction action {};
  action.sa_handler = judge_crash;
  sigaction(SIGSEGV, &action, &earlier_action);
}

/// Never above what the user's `ulimit` says.
void lower(__rlimit_resource resource, std::uint64_t limit)
{
  rlimit limits{};
  getrlimit(resource, &limits);
  limits.rlim_cur = limits.rlim_max = std::min<rlim_t>({limit, limits.rlim_cur, limits.rlim_max});
  setrlimit(resource, &limits);
}

/// All that changes a file or a folder is handled, and no rule allows any of it. Kernels before
/// 5.13 have no Landlock; there the filter of system calls stands alone.
void forbid_changes_by_landlock()
{
  constexpr std::uint64_t changes =
      LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
      LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR |
      LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
      LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;
  const std::uint64_t handled = changes;  // the first field of landlock_ruleset_attr
  const long ruleset = syscall(SYS_landlock_create_ruleset, &handled, sizeof(handled), 0);
  if (ruleset < 0) return;
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  syscall(SYS_landlock_restrict_self, ruleset, 0);
  close(static_cast<int>(ruleset));
}

/// Whether nobody is left to read the answer of an errand: who started it may have ended before
/// this process was bound to that end.
bool is_left_alone()
{
  pollfd answer{answer_descriptor, 0, 0};
  return ::poll(&answer, 1, 0) > 0 && (answer.revents & POLLERR) != 0;
}

}  // namespace

void end_with_caller()
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (is_left_alone()) _exit(exit_left_alone);
}

void confine(const Limits& limits)
{
  end_with_caller();
  std::set_new_handler([] { _exit(exit_out_of_memory); });
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_FSIZE, 1 << 20);  // of files in memory; of others there are none
  lower(RLIMIT_NOFILE, 64);
  lower(RLIMIT_CPU, std::uint64_t(std::ceil(limits.seconds)) + 1);
  const std::uint64_t size = size_of_process();
  watch_crashes(size, limits.memory);
  lower(RLIMIT_AS, size + limits.memory);
  forbid_changes_by_landlock();
  filter_system_calls();
}

}  // namespace chladni::confinement
