#include "mesh/decks/nastran_cards.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "mesh/decks/deck_text.hpp"

namespace chladni::mesh {
namespace {

/// A line cut into its name, its fields and the mark of a continuation to come.
struct CutLine {
  std::string name;
  std::vector<std::string> fields;
  std::string mark;
  bool is_large;
};

/// Each tab leads to the next column of eight.
std::string with_blanks(std::string_view line)
{
  std::string text;
  for (const char c : line)
    if (c == '\t')
      text.append(8 - text.size() % 8, ' ');
    else
      text += c;
  return text;
}

CutLine cut_fixed(const std::string& line)
{
  constexpr std::size_t small = 8, large = 16, behind = 72;
  CutLine cut{
      .name = capitals(trimmed(std::string_view(line).substr(0, small))),
      .fields = {},
      .mark = line.size() > behind ? capitals(trimmed(std::string_view(line).substr(behind))) : "",
      .is_large = false};
  cut.is_large = cut.name.find('*') != std::string::npos;
  const std::size_t width = cut.is_large ? large : small;
  for (std::size_t at = small; at < behind; at += width) {
    const std::string_view text(line);
    cut.fields.push_back(at < line.size() ? capitals(trimmed(text.substr(at, width))) : "");
  }
  return cut;
}

/// A mark in the tenth field of a free line; more fields, or a number there, would be lost.
std::string mark_of(const std::vector<std::string>& words, std::size_t n_fields, int line)
{
  if (words.size() <= n_fields + 1) return "";
  const std::string& mark = words[n_fields + 1];
  const bool is_number = mark.find_first_of("0123456789.-") == 0;
  const bool is_more = std::any_of(words.begin() + std::ptrdiff_t(n_fields) + 2, words.end(),
                                   [](const std::string& word) { return !word.empty(); });
  if (!is_number && !is_more) return mark;
  throw Error(
      fmt::format("line {}: has more than {} fields behind its name; put the others on a "
                  "line that begins with a comma",
                  line, n_fields));
}

CutLine cut_free(const std::string& line, int number)
{
  std::vector<std::string> words = cut_at_commas(line);
  for (std::string& word : words) word = capitals(word);
  CutLine cut{.name = words.front(), .fields = {}, .mark = "", .is_large = false};
  cut.is_large = cut.name.find('*') != std::string::npos;
  const std::size_t n = cut.is_large ? 4 : 8;
  for (std::size_t i = 1; i <= n; ++i) cut.fields.push_back(i < words.size() ? words[i] : "");
  cut.mark = mark_of(words, n, number);
  return cut;
}

std::string without_signs(std::string mark)
{
  std::erase_if(mark, [](char c) { return c == '+' || c == '*'; });
  return mark;
}

bool is_continuation(const CutLine& cut)
{
  return cut.name.empty() || cut.name.front() == '+' || cut.name.front() == '*';
}

/// The cards, and the mark that the last line of the last one ends with.
class Collection {
 public:
  void add(const CutLine& cut, int line)
  {
    const std::size_t width = cut.is_large ? 4 : 8;
    if (!is_continuation(cut))
      cards_.emplace_back(without_signs(cut.name), line);
    else if (cards_.empty())
      throw Error(fmt::format("line {}: continues no entry", line));
    else
      check_mark(cut, line);
    cards_.back().append(cut.fields, width);
    mark_ = without_signs(cut.mark);
  }
  std::vector<Card> take() { return std::move(cards_); }

 private:
  void check_mark(const CutLine& cut, int line) const
  {
    const std::string mark = without_signs(cut.name);
    if (mark.empty() || mark_.empty() || mark == mark_) return;
    throw Error(
        fmt::format("line {}: the continuation {} stands behind a line that asks for {}; put "
                    "each behind its own line",
                    line, mark, mark_));
  }

  std::vector<Card> cards_;
  std::string mark_;
};

/// Where the bulk data begin: behind BEGIN BULK, or with the text where there is no such line.
std::size_t begin_of_bulk(const std::string& text)
{
  std::size_t begin = 0;
  for_each_line(text, 0, [&](std::string_view whole, int) {
    const std::string line = capitals(trimmed(whole));
    const bool is_begin = line.starts_with("BEGIN") && line.find("BULK") != std::string::npos;
    if (is_begin) begin = std::size_t(whole.data() - text.data()) + whole.size() + 1;
    return !is_begin;
  });
  return begin;
}

}  // namespace

std::vector<Card> nastran_cards(const std::string& text)
{
  Collection cards;
  for_each_line(text, begin_of_bulk(text), [&](std::string_view whole, int number) {
    const std::string unmarked = with_blanks(whole);
    const std::string line = unmarked.substr(0, unmarked.find('$'));
    const std::string start = capitals(trimmed(line)).substr(0, 7);
    if (start.empty()) return true;
    if (start == "INCLUDE")
      throw Error(fmt::format("line {}: INCLUDE: put the other file in its place", number));
    if (start == "ENDDATA") return false;
    const bool is_free = line.find(',') != std::string::npos;
    cards.add(is_free ? cut_free(line, number) : cut_fixed(line), number);
    return true;
  });
  return cards.take();
}

}  // namespace chladni::mesh
