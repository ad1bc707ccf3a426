#pragma once

#include <string>

namespace chladni::linear {

/// Checks whether the address limit of the shell (`ulimit -v`) leaves room for the buffers that the
/// libraries take at their start: OpenBLAS asks for them forever if it does not get them. If there
/// is room, takes the buffer of this thread before others use the memory.
/// @return one sentence about what is lacking and what to do; empty if nothing is. In the former
///         case the process must end by `_exit`: at a normal exit OpenBLAS waits for threads that
///         do not end.
/// @note   To be called in main, before MPI starts.
std::string lacking_addresses();

}  // namespace chladni::linear
