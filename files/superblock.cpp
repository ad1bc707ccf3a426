#include "files/superblock.hpp"

#include <array>
#include <cstdint>
#include <fstream>

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

}  // namespace

bool place_superblock(const std::string& path, std::size_t start)
{
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

}  // namespace chladni::files
