#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Splitting the text of decks into lines and fields.
namespace chladni::mesh {

/// The text without blanks, tabs and carriage returns at both ends.
std::string trimmed(std::string_view text);

/// The text in capitals.
std::string capitals(std::string text);

/// The parts between the commas of a line, trimmed.
std::vector<std::string> cut_at_commas(std::string_view line);

/// Calls take(line, number) for each line that begins at or after the place `begin` of the text,
/// until it returns false. Lines are numbered from the start of the text, from 1.
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
