#include "common/files/input_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "common/error.hpp"

namespace chladni::files {

namespace {

const char* name_of(std::filesystem::file_type type)
{
  switch (type) {
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::fifo:
      return "a FIFO";
    case std::filesystem::file_type::socket:
      return "a socket";
    default:
      return "a device";
  }
}

}  // namespace

std::uint64_t regular_file_size(const std::string& path)
{
  std::error_code failure;
  const std::filesystem::file_type type = std::filesystem::status(path, failure).type();
  using std::filesystem::file_type;
  if (type == file_type::not_found || type == file_type::none || type == file_type::unknown)
    throw Error(fmt::format("{}: no such file, or not readable", path));
  if (type != file_type::regular)
    throw Error(fmt::format("{}: is {}, expected an ordinary file", path, name_of(type)));
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure) throw Error(fmt::format("{}: no such file, or not readable", path));
  return size;
}

std::string file_digest(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  constexpr std::size_t piece = Xxh64::stripe << 11;
  std::vector<std::uint8_t> bytes(piece);
  Xxh64 digest;
  std::size_t n = piece;
  while (n == piece) {
    file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(piece));
    n = static_cast<std::size_t>(file.gcount());
    if (n == piece) digest.add(bytes);
  }
  if (!file.eof()) return "";
  return fmt::format("{:016x}", digest.finish(std::span(bytes).first(n)));
}

namespace {

/// Little-endian, as the digest wants it on every machine.
template <class Word>
Word word_at(const std::uint8_t* bytes)
{
  Word word;
  std::memcpy(&word, bytes, sizeof word);
  if constexpr (std::endian::native == std::endian::big)
    word = sizeof word == 8 ? Word(__builtin_bswap64(word)) : Word(__builtin_bswap32(word));
  return word;
}

}  // namespace

constexpr std::uint64_t Xxh64::round(std::uint64_t lane, std::uint64_t word)
{
  return std::rotl(lane + word * p2, 31) * p1;
}

void Xxh64::add(std::span<const std::uint8_t> bytes)
{
  assert(bytes.size() % stripe == 0);
  auto [a, b, c, d] = lanes_;
  for (const std::uint8_t* s = bytes.data(); s != bytes.data() + bytes.size(); s += stripe) {
    a = round(a, word_at<std::uint64_t>(s));
    b = round(b, word_at<std::uint64_t>(s + 8));
    c = round(c, word_at<std::uint64_t>(s + 16));
    d = round(d, word_at<std::uint64_t>(s + 24));
  }
  lanes_ = {a, b, c, d};
  length_ += bytes.size();
}

std::uint64_t Xxh64::merged_lanes() const
{
  const auto& [a, b, c, d] = lanes_;
  std::uint64_t hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
  for (const std::uint64_t lane : lanes_) hash = (hash ^ round(0, lane)) * p1 + p4;
  return hash;
}

std::uint64_t Xxh64::finish(std::span<const std::uint8_t> rest)
{
  const std::size_t whole = rest.size() - rest.size() % stripe;
  add(rest.first(whole));
  rest = rest.subspan(whole);
  std::uint64_t hash = (length_ >= stripe ? merged_lanes() : p5) + length_ + rest.size();
  for (; rest.size() >= 8; rest = rest.subspan(8)) {
    hash ^= round(0, word_at<std::uint64_t>(rest.data()));
    hash = std::rotl(hash, 27) * p1 + p4;
  }
  if (rest.size() >= 4) {
    hash ^= word_at<std::uint32_t>(rest.data()) * p1;
    hash = std::rotl(hash, 23) * p2 + p3;
    rest = rest.subspan(4);
  }
  for (const std::uint8_t byte : rest) hash = std::rotl(hash ^ byte * p5, 11) * p1;
  hash = (hash ^ (hash >> 33)) * p2;
  hash = (hash ^ (hash >> 29)) * p3;
  return hash ^ (hash >> 32);
}

}  // namespace chladni::files
