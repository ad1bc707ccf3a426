#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace chladni::files {

/// The size of an ordinary file, bytes. The file is not opened, since opening a FIFO waits for a
/// writer.
/// @throws chladni::Error when there is no such file, or it is a folder, a FIFO, a socket or a
///         device.
std::uint64_t regular_file_size(const std::string& path);

/// The XXH64 digest of a file's bytes, in hexadecimal. It detects changes, but no forgery.
/// @return empty if the file cannot be read
std::string file_digest(const std::string& path);

/// The digest XXH64 with seed 0, as printed by `xxhsum -H64`, of bytes that arrive in pieces. It
/// detects damage, but no forgery.
/// Source: Collet, xxHash fast digest algorithm, specification 0.1.1 (XXH64).
class Xxh64 {
 public:
  static constexpr std::size_t stripe = 32;

  /// Adds bytes.
  /// @param bytes  whole stripes: a multiple of 32 bytes
  void add(std::span<const std::uint8_t> bytes);
  /// Adds the last bytes.
  /// @param rest  any number of bytes
  /// @return the digest of all bytes
  std::uint64_t finish(std::span<const std::uint8_t> rest);

 private:
  std::uint64_t merged_lanes() const;

  static constexpr std::uint64_t p1 = 0x9E3779B185EBCA87, p2 = 0xC2B2AE3D27D4EB4F,
                                 p3 = 0x165667B19E3779F9, p4 = 0x85EBCA77C2B2AE63,
                                 p5 = 0x27D4EB2F165667C5;
  static constexpr std::uint64_t round(std::uint64_t lane, std::uint64_t word);

  std::array<std::uint64_t, 4> lanes_ = {p1 + p2, p2, 0, 0 - p1};
  std::uint64_t length_ = 0;
};

}  // namespace chladni::files
