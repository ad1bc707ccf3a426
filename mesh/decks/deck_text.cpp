#include "mesh/decks/deck_text.hpp"

#include <algorithm>
#include <cctype>

namespace chladni::mesh {

std::string trimmed(std::string_view text)
{
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::string capitals(std::string text)
{
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::vector<std::string> cut_at_commas(std::string_view line)
{
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    words.push_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return words;
}

}  // namespace chladni::mesh
