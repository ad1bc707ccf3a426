#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace chladni::fuzz {

/// One run of a reader of HDF5 files that may end in a chladni::Error and in nothing else. Bytes
/// that begin as HDF5 files do are the file; all others say what to do to the golden one (see
/// `damage`), which is sealed then.
void feed(std::span<const std::uint8_t> bytes, const std::string& golden,
          const std::function<void(const std::string& path)>& read);

}  // namespace chladni::fuzz
