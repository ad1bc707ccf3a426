#include "scene/parse_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "common/error.hpp"

namespace chladni::scene {
namespace {

/// Behind the text in quotes, or the comment, that begins at `at`; the end of a line ends both but
/// for texts in three quotes.
std::size_t behind_quoted(std::string_view text, std::size_t at)
{
  const char quote = text[at];
  if (quote == '#') return std::min(text.find('\n', at), text.size());
  const std::string_view three = text.substr(at, 3);
  const bool is_long = three == std::string(3, quote);
  std::size_t i = at + (is_long ? 3 : 1);
  for (; i < text.size(); ++i)
    if (text[i] == '\\' && quote == '"')
      ++i;
    else if (is_long ? text.substr(i, 3) == three : text[i] == quote || text[i] == '\n')
      return i + (is_long ? 3 : 1);
  return text.size();
}

}  // namespace

toml::table parse_values(std::string_view text, const std::string& file)
{
  int parts = 1, line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'' || c == '#') {
      const std::size_t next = behind_quoted(text, i);
      line += static_cast<int>(std::count(text.begin() + i, text.begin() + next, '\n'));
      i = next;
      continue;
    }
    if (c == '.' && ++parts > key_parts_max) {
      throw Error(fmt::format("{}:{}: a key has more than {} parts; no key of a scene has so many",
                              file, line, key_parts_max));
    }
    if (std::string_view("=,{}[]\n").find(c) != std::string_view::npos) parts = 1;
    line += c == '\n' ? 1 : 0;
    ++i;
  }
  return toml::parse(text, file);
}

}  // namespace chladni::scene
