#include "files/seal.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "common/error.hpp"
#include "files/hdf5_handle.hpp"
#include "files/replacement.hpp"
#include "files/trial_reading.hpp"
#include "files/xxh64.hpp"

namespace chladni::files {
namespace {

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

bool opens(const std::string& path)
{
  silence_errors();
  return survives_reading(path) &&
         Handle{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose}.valid();
}

/// Where HDF5 begins: at once, or behind a seal, which may be damaged.
std::size_t start_of_hdf5(const std::string& path)
{
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
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(fmt::format("{}: no such file, or not readable", path));
  const std::string seal = beginning(file);
  if (seal.starts_with(hdf5_begins)) return false;
  if (!seal.starts_with(seal_begins))
    throw Error(fmt::format(
        "{}: is neither an HDF5 file nor one that Chladni sealed, or its beginning is damaged",
        path));
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
  {
    std::ifstream file(path, std::ios::binary);
    std::ofstream copy(replacement.temporary(), std::ios::binary);
    copy << std::string(seal_size, '\n') << file.seekg(std::streamoff(start)).rdbuf() << std::flush;
    if (!copy) replacement.fail();
  }
  if (!write_seal(replacement.temporary())) replacement.fail();
  if (!opens(replacement.temporary()))
    throw Error(fmt::format("{}: cannot be sealed: libhdf5 cannot read it either", path));
  replacement.commit();
}

}  // namespace chladni::files
