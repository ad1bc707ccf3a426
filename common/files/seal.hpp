#pragma once

#include <cstddef>
#include <string>

/// The seal of a file: its first 512 bytes, which HDF5 leaves to others (a "user block"), state as
/// text the length of the file and the digest of the bytes after them. libhdf5 trusts damaged
/// metadata and may read beyond its memory; the seal detects damage before libhdf5 sees it. It has
/// no key: whoever forges a file can seal it, so a seal gives no privileges.

namespace chladni::files {

/// Bytes; the smallest user block of HDF5.
constexpr std::size_t seal_size = 512;

/// Seals a file whose first 512 bytes are reserved for the seal.
/// @return false if it could not be read or written
bool write_seal(const std::string& path);

/// Compares a file with its seal.
/// @return true if it has one. Without a seal, a file must begin as HDF5, as files of the first
///         release and of other programs do.
/// @throws chladni::Error when it was damaged, cut short or changed, or begins in another way.
bool check_seal(const std::string& path);

/// Seals the present contents of a file, with or without an older seal. The file is replaced as a
/// whole.
/// @throws chladni::Error when it must not be read (trial_reading.hpp), or cannot be written.
void seal_file(const std::string& path);

}  // namespace chladni::files
