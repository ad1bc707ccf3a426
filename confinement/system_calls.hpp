#pragma once

#include <optional>

namespace chladni::confinement {

/// What a process that reads a stranger's file has no business with.
enum class Offence { program, writing, network };

/// From here on, and for good, the kernel ends this process when it wants to start a program, to
/// open a file for writing, or to use the network: by a filter of system calls (seccomp) that lets
/// through what reading and computing need and answers anything else, such as the removal of a
/// file, "not permitted". What is open stays open.
/// @throws chladni::Error when the kernel or the processor has no such filter.
void filter_system_calls();

/// The offence for which a process ended with this exit code, if it did.
std::optional<Offence> offence_of(int exit_code);

}  // namespace chladni::confinement
