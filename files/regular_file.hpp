#pragma once

#include <cstdint>
#include <string>

namespace chladni::files {

/// The size of an ordinary file, bytes. The file is not opened, since opening a FIFO waits for a
/// writer.
/// @throws chladni::Error when there is no such file, or it is a folder, a FIFO, a socket or a
///         device.
std::uint64_t regular_file_size(const std::string& path);

}  // namespace chladni::files
