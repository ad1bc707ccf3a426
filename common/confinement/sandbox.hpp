#pragma once

#include <linux/audit.h>

#include <cstdint>
#include <optional>
#include <span>

namespace chladni::confinement {

/// The resources that a process may take in addition to those it has.
struct Limits {
  std::uint64_t memory;  ///< bytes of address space
  double seconds;        ///< s of CPU time
};

/// Exit code of a confined process that ran out of memory, or that crashed with more than half of
/// its memory in use.
inline constexpr int exit_out_of_memory = 111;

/// Exit code of a confined process on an errand whose caller no longer waits.
inline constexpr int exit_left_alone = 112;

/// Lets this process on an errand end with the process that started it, now if that has ended.
void end_with_caller();

/// Confines this process permanently: it can read, compute, and write its result to files that are
/// already open (see `filter_system_calls`). A kernel with Landlock also forbids, by another
/// mechanism, all changes of files. The process ends with the process that started it.
/// @throws chladni::Error as `filter_system_calls`.
void confine(const Limits& limits);

/// Actions that a process that reads a stranger's file must not take.
enum class Offence { program, writing, network };

/// Makes the kernel permanently end this process when it tries to start a program, to open a file
/// for writing, or to use the network. A filter of system calls (seccomp) allows what reading and
/// computing need, and answers other calls, such as removing a file, with "not permitted". Open
/// files stay open.
/// @throws chladni::Error when the kernel or the processor has no such filter.
void filter_system_calls();

/// The offence that ended a process with this exit code; absent for other codes.
std::optional<Offence> offence_of(int exit_code);

}  // namespace chladni::confinement

/// Numbers of system calls on this processor, grouped by their use in a process that reads a file.

namespace chladni::confinement {

/// The kernel's identifier of this processor; 0 for those on which the filter was never tested.
#if defined(__x86_64__) && defined(__LP64__)
inline constexpr unsigned native_architecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
inline constexpr unsigned native_architecture = AUDIT_ARCH_AARCH64;
#else
inline constexpr unsigned native_architecture = 0;
#endif

/// The calls for reading files, memory, threads, clocks and signals to the process itself.
std::span<const long> harmless_calls();

/// The calls that start processes and programs, whatever their arguments.
std::span<const long> starting_calls();

/// The calls that create sockets.
std::span<const long> network_calls();

}  // namespace chladni::confinement
