#pragma once

#include <string>

namespace chladni::linear {

/// Where the shell limits the addresses of a process (`ulimit -v`), what the libraries take at
/// their start may not fit: OpenBLAS asks for its buffers again and again, without end, when it
/// does not get them. Where it fits, takes the buffer of this thread, before others take the
/// memory.
/// @return what is lacking and what to do, in one sentence; empty where nothing is. The process
///         must then end by `_exit`: at exit OpenBLAS waits for threads that do not end.
/// @note   To be called in main, before MPI starts.
std::string lacking_addresses();

}  // namespace chladni::linear
