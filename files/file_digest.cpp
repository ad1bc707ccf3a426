#include "files/file_digest.hpp"

#include <fmt/format.h>

#include <fstream>
#include <vector>

#include "files/xxh64.hpp"

namespace chladni::files {

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

}  // namespace chladni::files
