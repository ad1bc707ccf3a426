#include "common/files/seal.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "common/error.hpp"
#include "common/files/hdf5_objects.hpp"
#include "common/files/input_file.hpp"
#include "common/files/output_file.hpp"
#include "common/files/trial_reading.hpp"

namespace chladni::files {

namespace {

constexpr std::size_t size_of_address = 8;

/// Little-endian, as the format has them.
std::uint64_t get_address(std::fstream& file, std::size_t at)
{
  std::array<char, size_of_address> bytes{};
  file.seekg(std::streamoff(at)).read(bytes.data(), bytes.size());
  std::uint64_t address = 0;
  for (std::size_t i = bytes.size(); i-- > 0;)
    address = address << 8 | static_cast<unsigned char>(bytes[i]);
  return address;
}

void put_address(std::fstream& file, std::size_t at, std::uint64_t address)
{
  std::array<char, size_of_address> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(address >> (8 * i));
  file.seekp(std::streamoff(at)).write(bytes.data(), bytes.size());
}

/// Writes into the superblock of an HDF5 file (versions 0 and 1, libhdf5's default) that HDF5
/// begins behind the seal, and shifts its end address likewise. libhdf5 finds the beginning itself;
/// other readers trust the superblock. Newer superblocks are left unchanged.
/// @return false if it could not be read or written
bool place_superblock(const std::string& path)
{
  constexpr std::size_t start = seal_size;
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  // Signature (8), versions (5), size of addresses (1), ...; version 1 has four bytes more.
  std::array<char, 14> beginning{};
  file.seekg(std::streamoff(start)).read(beginning.data(), beginning.size());
  const auto version = static_cast<unsigned char>(beginning[8]),
             size = static_cast<unsigned char>(beginning[13]);
  if (!file) return false;
  if (version > 1 || size != size_of_address) return true;
  const std::size_t at = start + (version == 0 ? 24 : 28);  // begin, free space, end
  const std::uint64_t begin = get_address(file, at), end = get_address(file, at + 16);
  put_address(file, at, start);
  put_address(file, at + 16, end - begin + start);  // of a file that is cut short beyond its bytes
  return static_cast<bool>(file.flush());
}

constexpr std::string_view hdf5_begins = "\x89HDF\r\n\x1a\n";
constexpr std::string_view seal_begins = "Chladni seal 1\nbytes ";

/// The text of a seal; of fixed size, so that there is one right text for each file.
std::string seal_text(std::uint64_t length, std::uint64_t digest)
{
  const std::string text = fmt::format(
      "{}{}\nxxh64 {:016x} of all bytes behind these {}\nWhat follows is an HDF5 file. When you "
      "have "
      "changed it on purpose: chladni seal FILE\n",
      seal_begins, length, digest, seal_size);
  return fmt::format("{:<{}}\n", text, seal_size - 1);
}

/// Of all that follows in the stream, in pieces that fit into a cache.
std::uint64_t digest_of(std::istream& file)
{
  std::vector<std::uint8_t> piece(8192 * Xxh64::stripe);
  Xxh64 hash;
  for (;;) {
    file.read(reinterpret_cast<char*>(piece.data()), std::streamsize(piece.size()));
    const auto n = static_cast<std::size_t>(file.gcount());
    if (n < piece.size()) return hash.finish(std::span(piece).first(n));
    hash.add(piece);
  }
}

/// The first bytes, or what there is of them.
std::string beginning(std::istream& file, std::size_t size = seal_size)
{
  std::string bytes(size, '\0');
  file.read(bytes.data(), std::streamsize(size));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

/// What a seal says of the length of its file; 0 if it says nothing.
std::uint64_t sealed_length(std::string_view seal)
{
  std::uint64_t length = 0;
  if (seal.starts_with(seal_begins))
    std::from_chars(seal.data() + seal_begins.size(), seal.data() + seal.size(), length);
  return length;
}

[[noreturn]] void refuse(const std::string& path, const std::string& reason)
{
  throw Error(fmt::format(
      "{}: is not as it was written: {}. Make it anew or take a copy; if it was changed "
      "on purpose, `chladni seal {}` (or `squeal seal`) accepts it",
      path, reason, path));
}

/// Copies HDF5 from byte `start` of a file on to the other, behind the place of a seal.
bool copy_hdf5(const std::string& from, std::size_t start, const std::string& to)
{
  std::ifstream file(from, std::ios::binary);
  std::ofstream copy(to, std::ios::binary);
  copy << std::string(seal_size, '\n') << file.seekg(std::streamoff(start)).rdbuf() << std::flush;
  return copy.good() && place_superblock(to);
}

/// @throws chladni::Error about `path` when its copy is not to be read.
void require_readable(const std::string& path, const std::string& copy)
{
  const auto refusal = refusal_of_trial(copy, limits_of_trial(std::filesystem::file_size(copy)));
  if (refusal) throw Error(fmt::format("{}: cannot be sealed: {}", path, *refusal));
  if (!Handle{H5Fopen(copy.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose}.valid())
    throw Error(fmt::format("{}: cannot be sealed: libhdf5 cannot read it either", path));
}

/// Where HDF5 begins: at once, or behind a seal, which may be damaged.
std::size_t start_of_hdf5(const std::string& path)
{
  regular_file_size(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(fmt::format("{}: no such file, or not readable", path));
  const std::string bytes = beginning(file, seal_size + hdf5_begins.size());
  if (bytes.starts_with(hdf5_begins)) return 0;
  if (bytes.ends_with(hdf5_begins)) return seal_size;
  throw Error(fmt::format("{}: cannot be sealed: it is no HDF5 file", path));
}

}  // namespace

bool write_seal(const std::string& path)
{
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(seal_size);
  if (!file) return false;
  const std::uint64_t digest = digest_of(file);
  if (file.bad()) return false;
  file.clear();  // of its end
  const auto length = static_cast<std::uint64_t>(file.tellg());
  file.seekp(0) << seal_text(length, digest) << std::flush;
  return file.good();
}

bool check_seal(const std::string& path)
{
  regular_file_size(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(fmt::format("{}: no such file, or not readable", path));
  const std::string seal = beginning(file);
  if (seal.starts_with(hdf5_begins)) return false;
  if (!seal.starts_with(seal_begins)) {
    throw Error(fmt::format(
        "{}: is neither an HDF5 file nor one that Chladni sealed, or its beginning is damaged",
        path));
  }
  const std::uint64_t length = std::filesystem::file_size(path);
  if (length != sealed_length(seal))
    refuse(path, fmt::format("it has {} bytes and had {}", length, sealed_length(seal)));
  if (seal != seal_text(length, digest_of(file)))
    refuse(path, "its bytes are not those that were sealed");
  return true;
}

void seal_file(const std::string& path)
{
  const std::size_t start = start_of_hdf5(path);
  Replacement replacement(path);
  const std::string& copy = replacement.temporary();
  if (!copy_hdf5(path, start, copy) || !write_seal(copy)) replacement.fail();
  require_readable(path, copy);
  replacement.commit();
}

}  // namespace chladni::files
