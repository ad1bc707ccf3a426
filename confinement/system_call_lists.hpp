#pragma once

#include <linux/audit.h>

#include <span>

/// Numbers of system calls on this processor, by what they are to a process that reads a file.
namespace chladni::confinement {

/// What the kernel calls this processor; 0 for those on which the filter was never tried.
#if defined(__x86_64__) && defined(__LP64__)
inline constexpr unsigned native_architecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
inline constexpr unsigned native_architecture = AUDIT_ARCH_AARCH64;
#else
inline constexpr unsigned native_architecture = 0;
#endif

/// Reading of files, memory, threads, clocks, signals to itself.
std::span<const long> harmless_calls();

/// Starting of processes and programs, whatever their arguments.
std::span<const long> starting_calls();

/// What makes a socket.
std::span<const long> network_calls();

}  // namespace chladni::confinement
