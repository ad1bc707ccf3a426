#include "mesh/exchange/unv_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/error.hpp"
#include "mesh/decks/deck_text.hpp"

namespace chladni::mesh {

bool UnvWords::at_end()
{
  skip_blanks();
  return line_ == dataset_.lines.size();
}

std::string UnvWords::line()
{
  if (column_ > 0) next_line();
  if (line_ == dataset_.lines.size()) refuse("ends in the midst of a record");
  const std::string found = trimmed(dataset_.lines[line_]);
  next_line();
  return found;
}

std::int64_t UnvWords::integer(const char* what)
{
  const std::string_view word = next(what);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  constexpr std::int64_t greatest = 2'147'483'647;
  if (error == std::errc() && end == word.data() + word.size() && std::abs(value) <= greatest)
    return value;
  refuse(fmt::format("\"{}\" is no {}, which is a whole number", word, what));
}

std::int64_t UnvWords::number(const char* what)
{
  const std::int64_t value = integer(what);
  if (value < 1) refuse(fmt::format("{} is no {}; those go from 1", value, what));
  return value;
}

double UnvWords::real(const char* what)
{
  const std::string_view word = next(what);
  std::string text(word);
  for (char& c : text) c = c == 'D' || c == 'd' ? 'E' : c;
  if (text.starts_with('+')) text.erase(0, 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value))
    return value;
  refuse(fmt::format("\"{}\" is no number, which {} is", word, what));
}

void UnvWords::refuse(std::string_view why) const
{
  const auto line = std::min(line_ + 1, dataset_.lines.size());
  throw Error(fmt::format("line {}: dataset {}: {}", dataset_.line + static_cast<int>(line),
                          dataset_.number, why));
}

void UnvWords::next_line()
{
  ++line_;
  column_ = 0;
}

void UnvWords::skip_blanks()
{
  while (line_ < dataset_.lines.size()) {
    column_ = std::min(dataset_.lines[line_].find_first_not_of(" \t\r", column_),
                       dataset_.lines[line_].size());
    if (column_ < dataset_.lines[line_].size()) return;
    next_line();
  }
}

std::string_view UnvWords::next(const char* what)
{
  if (at_end()) refuse(fmt::format("ends where {} should stand", what));
  const std::string_view rest = dataset_.lines[line_].substr(column_);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r"));
  column_ += word.size();
  return word;
}

}  // namespace chladni::mesh
