#include "mesh/decks/abaqus_keywords.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/error.hpp"
#include "mesh/decks/deck_text.hpp"

namespace chladni::mesh {
namespace {

std::string unquoted(std::string text)
{
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    return text.substr(1, text.size() - 2);
  return text;
}

Keyword keyword_of(const std::string& line, int number)
{
  const std::vector<std::string> words = cut_at_commas(line.substr(1));
  Keyword keyword{.name = words.front(), .line = number, .parameters = {}, .rows = {}};
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].empty()) continue;
    const std::size_t equals = std::min(words[i].find('='), words[i].size());
    const std::string value =
        equals < words[i].size() ? unquoted(capitals(words[i].substr(equals + 1))) : "";
    keyword.parameters[capitals(words[i].substr(0, equals))] = value;
  }
  return keyword;
}

}  // namespace

const std::string& Keyword::parameter(const std::string& wanted) const
{
  const auto found = parameters.find(wanted);
  if (found == parameters.end() || found->second.empty())
    refuse(fmt::format("needs {} = ...", wanted));
  return found->second;
}

void Keyword::expect_only(const std::set<std::string>& known) const
{
  for (const auto& [parameter, value] : parameters)
    if (!known.contains(parameter))
      refuse(fmt::format("{} is not known here; known: {}", parameter, fmt::join(known, ", ")));
}

void Keyword::refuse(std::string_view why) const
{
  throw Error(fmt::format("line {}: *{}: {}", line, name, why));
}

void Keyword::refuse(const KeywordRow& row, std::string_view why) const
{
  throw Error(fmt::format("line {}: *{}: {}", row.line, name, why));
}

std::string_view Keyword::field(const KeywordRow& row, std::size_t i)
{
  return i < row.fields.size() ? std::string_view(row.fields[i]) : std::string_view();
}

bool Keyword::is_integer(std::string_view text) const
{
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::int64_t Keyword::integer(const KeywordRow& row, std::size_t i, std::string_view what) const
{
  const std::string_view text = field(row, i);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  constexpr std::int64_t greatest = 2'147'483'647;
  if (error == std::errc() && end == text.data() + text.size() && value >= 1 && value <= greatest)
    return value;
  refuse(row, fmt::format("\"{}\" is no {}; that is a number from 1 to {}", text, what, greatest));
}

double Keyword::real(const KeywordRow& row, std::size_t i, std::string_view what) const
{
  std::string text(field(row, i));
  std::ranges::replace(text, 'D', 'E');
  if (text.starts_with('+')) text.erase(0, 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value))
    return value;
  refuse(row, fmt::format("\"{}\" is no number, which {} is", field(row, i), what));
}

double Keyword::real_or(const KeywordRow& row, std::size_t i, std::string_view what,
                        double otherwise) const
{
  return field(row, i).empty() ? otherwise : real(row, i, what);
}

std::vector<Keyword> abaqus_keywords(const std::string& text)
{
  std::vector<Keyword> keywords;
  bool goes_on = false;  // the line of a keyword that ends with a comma
  for_each_line(text, 0, [&](std::string_view whole, int number) {
    const std::string line = trimmed(whole);
    if (line.empty() || line.starts_with("**")) return true;
    if (goes_on) {
      const Keyword more = keyword_of("*," + line, number);
      keywords.back().parameters.insert(more.parameters.begin(), more.parameters.end());
    } else if (line.starts_with('*')) {
      keywords.push_back(keyword_of(line, number));
      keywords.back().name = capitals(keywords.back().name);
    } else if (keywords.empty()) {
      throw Error(fmt::format("line {}: stands before the first keyword", number));
    } else {
      std::vector<std::string> fields = cut_at_commas(line);
      for (std::string& field : fields) field = unquoted(capitals(field));
      keywords.back().rows.push_back({.line = number, .fields = std::move(fields)});
      return true;
    }
    goes_on = line.back() == ',';
    return true;
  });
  return keywords;
}

}  // namespace chladni::mesh
