#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstring>

#include "common/error.hpp"
#include "mesh/exchange/vtu_values.hpp"

namespace chladni::mesh {
namespace {

constexpr std::uint64_t most_bytes = std::uint64_t(1) << 34;

/// 0 to 63; 64 for what is none.
unsigned digit_of(char c)
{
  if (c >= 'A' && c <= 'Z') return static_cast<unsigned>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<unsigned>(c - 'a') + 26;
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0') + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : 64;
}

/// Takes bytes from the front, out of base64 where they are in that. Header and values may be
/// encoded apart, so that padding ends no more than its four letters.
class Source {
 public:
  Source(std::string_view encoded, bool is_base64) : rest_(encoded), is_base64_(is_base64) {}

  std::string take(std::uint64_t n)
  {
    if (n > most_bytes || n > rest_.size() + pending_.size())
      throw Error(fmt::format("ends before the {} bytes that it says", n));
    if (!is_base64_) {
      std::string bytes(rest_.substr(0, n));
      rest_.remove_prefix(n);
      return bytes;
    }
    std::string bytes = std::move(pending_);
    while (bytes.size() < n) take_letters(bytes);
    pending_ = bytes.substr(n);
    bytes.resize(n);
    return bytes;
  }

 private:
  void take_letters(std::string& bytes)
  {
    std::array<char, 4> letters{};
    for (char& letter : letters) {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
      if (rest_.empty()) throw Error("ends before the bytes that it says");
      letter = rest_.front();
      rest_.remove_prefix(1);
    }
    const int n_bytes = letters[2] == '=' ? 1 : letters[3] == '=' ? 2 : 3;
    unsigned value = 0;
    for (int k = 0; k < 4; ++k) {
      const unsigned digit = k > n_bytes ? 0 : digit_of(letters[static_cast<std::size_t>(k)]);
      if (digit > 63) throw Error("holds what is no base64");
      value = value << 6 | digit;
    }
    for (int k = 0; k < n_bytes; ++k) bytes += static_cast<char>(value >> (16 - 8 * k) & 0xFF);
  }

  std::string_view rest_;
  bool is_base64_;
  std::string pending_;  ///< decoded and not yet taken
};

std::uint64_t header_number(Source& source, std::size_t n_bytes)
{
  const std::string bytes = source.take(n_bytes);
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data(), n_bytes);
  return number;
}

std::string unpacked(const std::string& packed, std::uint64_t size)
{
  constexpr std::uint64_t best_ratio = 1032;  // of deflate
  if (size > best_ratio * packed.size()) throw Error("does not unpack to what it says");
  std::string bytes(size, '\0');
  uLongf n = size;
  const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &n,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (result != Z_OK || n != size) throw Error("does not unpack to what it says");
  return bytes;
}

/// Number of blocks, size of each, size of the last (0: like the others), packed sizes; then the
/// blocks.
std::string take_blocks(Source& source, std::size_t header_bytes)
{
  const std::uint64_t n = header_number(source, header_bytes);
  const std::uint64_t size = header_number(source, header_bytes);
  const std::uint64_t last = header_number(source, header_bytes);
  std::vector<std::uint64_t> packed_sizes;
  for (std::uint64_t i = 0; i < n; ++i) packed_sizes.push_back(header_number(source, header_bytes));
  std::string bytes;
  for (std::uint64_t i = 0; i < n; ++i) {
    const bool is_last = i + 1 == n && last != 0;
    bytes += unpacked(source.take(packed_sizes[i]), is_last ? last : size);
  }
  return bytes;
}

}  // namespace

std::string vtu_bytes(std::string_view encoded, const VtuEncoding& encoding)
{
  Source source(encoded, encoding.is_base64);
  if (encoding.is_compressed) return take_blocks(source, encoding.header_bytes);
  const std::uint64_t n = header_number(source, encoding.header_bytes);
  return source.take(n);
}

}  // namespace chladni::mesh
