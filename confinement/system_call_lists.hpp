#pragma once

#include <linux/audit.h>

#include <span>

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
