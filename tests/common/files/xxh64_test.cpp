#include "common/files/input_file.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace chladni::files {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::uint64_t digest(std::string_view text)
{
  return Xxh64().finish({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::vector<std::uint8_t> sevens(std::size_t n)
{
  std::vector<std::uint8_t> bytes(n);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::uint8_t>(7 * i);
  return bytes;
}

// What libxxhash 0.8.1 says of the same bytes.
TEST(Xxh64, IsThatOfTheReferenceLibrary)
{
  EXPECT_EQ(digest(""), 0xef46db3751d8e999u);
  EXPECT_EQ(digest("a"), 0xd24ec4f1a98c6e5bu);
  EXPECT_EQ(digest("abc"), 0x44bc2cf5ad770999u);
  EXPECT_EQ(Xxh64().finish(sevens(31)), 0x0f187c62b1e722b7u);
  EXPECT_EQ(Xxh64().finish(sevens(32)), 0x91b0cb0931a8c629u);
  EXPECT_EQ(Xxh64().finish(sevens(33)), 0x931b043cf8d65b94u);
  EXPECT_EQ(Xxh64().finish(sevens(63)), 0x219110bf13e2fa26u);
  EXPECT_EQ(Xxh64().finish(sevens(71)), 0xa076db31239c3ea4u);
  EXPECT_EQ(Xxh64().finish(sevens(100)), 0x8e2272c08247d5dbu);
  EXPECT_EQ(Xxh64().finish(sevens(199)), 0xfa32fca67b79f940u);
}

TEST(Xxh64, DoesNotDependOnThePieces)
{
  const std::vector<std::uint8_t> bytes = sevens(199);
  for (std::size_t first = 0; first <= 192; first += Xxh64::stripe) {
    Xxh64 hash;
    hash.add(Bytes(bytes).first(first));
    EXPECT_EQ(hash.finish(Bytes(bytes).subspan(first)), Xxh64().finish(bytes)) << first;
  }
}

}  // namespace
}  // namespace chladni::files
