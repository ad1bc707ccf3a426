#pragma once

#include <cstdint>
#include <string>

namespace chladni::files {

/// The bytes of an ordinary file. Nothing is opened: the opening of a FIFO waits for a writer.
/// @throws chladni::Error when there is no such file, or it is a folder, a FIFO, a socket or a
/// device.
std::uint64_t regular_file_size(const std::string& path);

}  // namespace chladni::files
