#include "common/confinement/sandbox.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <vector>

#include "common/confinement/helper_process.hpp"
#include "common/error.hpp"

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

namespace {

constexpr int first_exit_code = 101;  ///< of the offences in their order

/// Commands of the machine that the kernel runs at each system call.
using Filter = std::vector<sock_filter>;

void load(Filter& filter, std::size_t offset)
{
  filter.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(offset)));
}

/// The lower half of an argument; the flags that matter stand there, on little-endian processors.
void load_argument(Filter& filter, int i)
{
  load(filter, offsetof(seccomp_data, args) + 8 * i);
}

void answer(Filter& filter, unsigned verdict)
{
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, verdict));
}

/// The next command is passed over unless the loaded word compares so with `value`.
void only_if(Filter& filter, unsigned short comparison, unsigned value)
{
  filter.push_back(
      BPF_JUMP(static_cast<unsigned short>(BPF_JMP | comparison | BPF_K), value, 0, 1));
}

/// What is done with one argument of a system call.
struct Condition {
  int argument;
  unsigned flags;  ///< any of these in it
  unsigned if_set;
  unsigned if_clear;
};

void judge(Filter& filter, long call, const Condition& condition)
{
  filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 4));
  load_argument(filter, condition.argument);
  only_if(filter, BPF_JSET, condition.flags);
  answer(filter, condition.if_set);
  answer(filter, condition.if_clear);
}

/// A call of which an argument must be a value, as that which says to whom it goes.
void allow_if_equal(Filter& filter, long call, int argument, unsigned value)
{
  filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 4));
  load_argument(filter, argument);
  only_if(filter, BPF_JEQ, value);
  answer(filter, SECCOMP_RET_ALLOW);
  answer(filter, SECCOMP_RET_ERRNO | EPERM);
}

void answer_all(Filter& filter, std::span<const long> calls, unsigned verdict)
{
  for (const long call : calls) {
    only_if(filter, BPF_JEQ, static_cast<unsigned>(call));
    answer(filter, verdict);
  }
}

void begin(Filter& filter)
{
  load(filter, offsetof(seccomp_data, arch));
  filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, native_architecture, 1, 0));
  answer(filter, SECCOMP_RET_KILL_PROCESS);
  load(filter, offsetof(seccomp_data, nr));
  constexpr unsigned second_table = 0x40000000;  // x32 numbers the same calls anew
  only_if(filter, BPF_JGE, second_table);
  answer(filter, SECCOMP_RET_KILL_PROCESS);
}

Filter fitting_filter()
{
  constexpr unsigned allow = SECCOMP_RET_ALLOW, refuse = SECCOMP_RET_ERRNO | EPERM;
  constexpr unsigned end = SECCOMP_RET_TRAP, missing = SECCOMP_RET_ERRNO | ENOSYS;
  constexpr unsigned writes = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;
  Filter filter;
  begin(filter);
  answer_all(filter, harmless_calls(), allow);
  judge(filter, SYS_openat, {.argument = 2, .flags = writes, .if_set = end, .if_clear = allow});
#ifdef SYS_open
  judge(filter, SYS_open, {.argument = 1, .flags = writes, .if_set = end, .if_clear = allow});
#endif
  judge(filter, SYS_clone,
        {.argument = 0, .flags = CLONE_THREAD, .if_set = allow, .if_clear = end});
  for (const long call : {SYS_mmap, SYS_mprotect})  // no code but what is there
    judge(filter, call, {.argument = 2, .flags = PROT_EXEC, .if_set = refuse, .if_clear = allow});
  const auto self = static_cast<unsigned>(getpid());
  for (const long call : {SYS_kill, SYS_tgkill}) allow_if_equal(filter, call, 0, self);
  // glibc takes clone and openat where these are missing, whose flags a filter sees.
  answer_all(filter, std::array<long, 2>{SYS_clone3, SYS_openat2}, missing);
  for (const std::span<const long> calls : {starting_calls(), network_calls()})
    answer_all(filter, calls, end);
  answer(filter, refuse);
  return filter;
}

Offence offence_of_call(long call)
{
  if (std::ranges::count(network_calls(), call) > 0) return Offence::network;
  const bool starts = call == SYS_clone || std::ranges::count(starting_calls(), call) > 0;
  return starts ? Offence::program : Offence::writing;
}

/// In the handler of a signal: nothing but the end.
void end_for_offence(int, siginfo_t* what, void*)
{
  _exit(first_exit_code + static_cast<int>(offence_of_call(what->si_syscall)));
}

}  // namespace

void filter_system_calls()
{
  struct sigaction action {};
  action.sa_sigaction = end_for_offence;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  sigaction(SIGSYS, &action, nullptr);
  Filter filter = fitting_filter();
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  const bool is_filtered = native_architecture != 0 &&
                           prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  if (!is_filtered) {
    throw Error(
        fmt::format("this system cannot keep a process from starting programs (seccomp: {})",
                    std::strerror(errno)));
  }
}

std::optional<Offence> offence_of(int exit_code)
{
  const int i = exit_code - first_exit_code;
  if (i < 0 || i > static_cast<int>(Offence::network)) return std::nullopt;
  return static_cast<Offence>(i);
}

}  // namespace chladni::confinement

// Younger processors lack the calls that stand between #ifdef and #endif.

namespace chladni::confinement {

namespace {

constexpr auto harmless = std::to_array<long>({
    SYS_read,
    SYS_pread64,
    SYS_readv,
    SYS_write,
    SYS_writev,
    SYS_lseek,
    SYS_close,
    SYS_fstat,
    SYS_newfstatat,
    SYS_statx,
    SYS_faccessat,
    SYS_readlinkat,
    SYS_getdents64,
    SYS_getcwd,
    SYS_dup,
    SYS_dup3,
    SYS_fadvise64,
    SYS_brk,
    SYS_munmap,
    SYS_mremap,
    SYS_madvise,
    SYS_futex,
    SYS_set_robust_list,
    SYS_rseq,
    SYS_sched_yield,
    SYS_getpid,
    SYS_gettid,
    SYS_getuid,
    SYS_geteuid,
    SYS_getgid,
    SYS_getegid,
    SYS_uname,
    SYS_clock_gettime,
    SYS_clock_nanosleep,
    SYS_clock_getres,
    SYS_gettimeofday,
    SYS_nanosleep,
    SYS_times,
    SYS_getrusage,
    SYS_sysinfo,
    SYS_getrandom,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_sigaltstack,
    SYS_exit,
    SYS_exit_group,
    SYS_restart_syscall,
    SYS_memfd_create,
    SYS_sched_getaffinity,
#ifdef SYS_faccessat2
    SYS_faccessat2,
#endif
#ifdef SYS_stat
    SYS_stat,
    SYS_lstat,
    SYS_access,
    SYS_readlink,
    SYS_dup2,
    SYS_time,
    SYS_arch_prctl,
    SYS_getdents,
#endif
});

}  // namespace

std::span<const long> harmless_calls()
{
  return harmless;
}

std::span<const long> starting_calls()
{
  static constexpr auto calls = std::to_array<long>({
      SYS_execve,
      SYS_execveat,
#ifdef SYS_fork
      SYS_fork,
      SYS_vfork,
#endif
  });
  return calls;
}

std::span<const long> network_calls()
{
  static constexpr auto calls = std::to_array<long>({SYS_socket, SYS_socketpair});
  return calls;
}

}  // namespace chladni::confinement
