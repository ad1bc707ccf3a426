#include "cli/writer_mark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <ios>
#include <iterator>

#include "cli/reserve_outputs.hpp"

namespace chladni::cli {
namespace {

constexpr std::string_view before = "<!-- written by Chladni for ", after = " -->\n";

/// What could end a comment, or begin another line, as %XX.
std::string encoded(const std::string& text)
{
  std::string all;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '_' || c == ' ';
    all += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return all;
}

std::string decoded(const std::string& text)
{
  std::string all;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const bool is_coded = text[i] == '%' && i + 2 < text.size();
    if (is_coded) std::from_chars(&text[i + 1], &text[i + 1] + 2, byte, 16);
    all += is_coded ? static_cast<char>(byte) : text[i];
    if (is_coded) i += 2;
  }
  return all;
}

}  // namespace

std::string writer_mark(const SceneArguments& arguments)
{
  return fmt::format("{}{}{}", before, encoded(scene_file_of(arguments)), after);
}

std::string marked_writer(const std::filesystem::path& file)
{
  constexpr std::streamoff longest = 16384;  // three times that of a path, and the words
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return "";
  in.seekg(std::max<std::streamoff>(0, std::streamoff(in.tellg()) - longest));
  const std::string end{std::istreambuf_iterator<char>(in), {}};
  const std::size_t at = end.rfind(before);
  if (at == std::string::npos || !end.ends_with(after)) return "";
  const std::size_t from = at + before.size();
  return decoded(end.substr(from, end.size() - after.size() - from));
}

}  // namespace chladni::cli
