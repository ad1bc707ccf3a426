#pragma once

#include <cstddef>
#include <string>

/// The seal of a file: its first 512 bytes, which HDF5 leaves to others (a "user block"), say in
/// text how long the whole is and what digest the bytes behind them have. libhdf5 believes what
/// damaged metadata claim and may read beyond its memory; the seal finds damage before libhdf5 sees
/// it.
namespace chladni::mbs_export::hdf5 {

constexpr std::size_t seal_size = 512;  ///< bytes; the least that HDF5 leaves free

/// Seals a file whose first 512 bytes are free for it.
/// @return whether it could be read and written
bool write_seal(const std::string& path);

/// Does nothing when the file is as it was sealed, or begins as HDF5 does and so has no seal: files
/// of the first releases, and of others.
/// @throws chladni::Error when it was damaged, cut short or changed since, or begins in another
/// way.
void check_seal(const std::string& path);

/// Seals what a file holds now, with or without an older seal; replaces it as a whole.
/// @throws chladni::Error when libhdf5 cannot open it, or it cannot be written.
void seal_file(const std::string& path);

}  // namespace chladni::mbs_export::hdf5
