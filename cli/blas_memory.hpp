#pragma once

namespace chladni::cli {

/// Where the shell limits the addresses of a process (`ulimit -v`), makes sure that what the
/// libraries take at their start fits: OpenBLAS asks for its buffers again and again, without end,
/// when it does not get them. Ends the program with a message where it does not fit.
/// @note   To be called in main, before MPI starts.
void check_address_limit();

}  // namespace chladni::cli
