#pragma once

#include <cstddef>
#include <string>

/// The seal of a file: its first 512 bytes, which HDF5 leaves to others (a "user block"), say in
/// text how long the whole is and what digest the bytes behind them have. libhdf5 believes what
/// damaged metadata claim and may read beyond its memory; the seal finds damage before libhdf5 sees
/// it.
namespace chladni::files {

constexpr std::size_t seal_size = 512;  ///< bytes; the least that HDF5 leaves free

/// Seals a file whose first 512 bytes are free for it.
/// @return whether it could be read and written
bool write_seal(const std::string& path);

/// Compares a file with its seal.
/// @return whether it has one; without it a file must begin as HDF5 does, as those of the first
///         release and of other programs do
/// @throws chladni::Error when it was damaged, cut short or changed since, or begins in another
/// way.
bool check_seal(const std::string& path);

/// Seals what a file holds now, with or without an older seal; replaces it as a whole.
/// @throws chladni::Error when libhdf5 cannot read it, or it cannot be written.
void seal_file(const std::string& path);

}  // namespace chladni::files
