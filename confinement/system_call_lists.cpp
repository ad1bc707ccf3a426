#include "confinement/system_call_lists.hpp"

#include <sys/syscall.h>

#include <array>

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
