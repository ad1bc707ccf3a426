#pragma once

#include <cstddef>
#include <string>

/// The seal of a file: its first 512 bytes, which HDF5 leaves to others (a "user block"), say in
/// text how long the whole is and what digest the bytes behind them have. libhdf5 believes what
/// damaged metadata claim and may read beyond its memory; the seal finds damage before libhdf5 sees
/// it. It has no key: who makes a file to deceive can seal it, so that a seal gives no privileges.
namespace chladni::files {

constexpr std::size_t seal_size = 512;  ///< bytes; the least that HDF5 leaves free

/// Where the seal of a file is: in its first bytes, or in a small file FILE.seal beside it, so that
/// the file is HDF5 from its first byte on, for readers that do not look for HDF5 further on.
enum class SealPlace { inside, beside };

/// Seals a file whose first 512 bytes are free for it.
/// @return whether it could be read and written
bool write_seal(const std::string& path);

/// Compares a file with its seal, inside or beside it.
/// @return whether it has one; without a seal inside a file must begin as HDF5 does, as those of
/// the first
///         release and of other programs do
/// @throws chladni::Error when it was damaged, cut short or changed since, or begins in another
/// way.
bool check_seal(const std::string& path);

/// Seals what a file holds now, with or without an older seal of either kind; replaces it as a
/// whole.
/// @throws chladni::Error when it is not to be read (trial_reading.hpp), or cannot be written.
void seal_file(const std::string& path, SealPlace place = SealPlace::inside);

/// The name of a seal beside its file, FILE.seal.
std::string detached_seal(const std::string& path);

/// Removes the seal beside a file that has one inside. Others' files of that name stay.
void remove_detached_seal(const std::string& path);

}  // namespace chladni::files
