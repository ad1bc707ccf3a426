#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The text of decks, cut into lines and fields.
namespace chladni::mesh {

/// Without blanks, tabs and carriage returns at both ends.
std::string trimmed(std::string_view text);

std::string capitals(std::string text);

/// What stands between the commas, trimmed.
std::vector<std::string> cut_at_commas(std::string_view line);

/// Hands on each line with its number, from the place `begin` of the text on, until `take` returns
/// false.
void for_each_line(const std::string& text, std::size_t begin, auto&& take)
{
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t found = text.find('\n', at);
    const std::size_t end = found == std::string::npos ? text.size() : found;
    ++number;
    if (at >= begin && !take(std::string_view(text).substr(at, end - at), number)) return;
    at = end + 1;
  }
}

}  // namespace chladni::mesh
