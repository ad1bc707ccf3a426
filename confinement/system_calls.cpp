#include "confinement/system_calls.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "common/error.hpp"
#include "confinement/system_call_lists.hpp"

namespace chladni::confinement {
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
