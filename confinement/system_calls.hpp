#pragma once

#include <optional>

namespace chladni::confinement {

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
