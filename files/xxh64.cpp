#include "files/xxh64.hpp"

#include <bit>
#include <cassert>
#include <cstring>

namespace chladni::files {
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
