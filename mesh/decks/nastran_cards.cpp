#include "mesh/decks/nastran_cards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>

#include "common/error.hpp"
#include "mesh/decks/deck_text.hpp"

namespace chladni::mesh {

namespace {

/// A line cut into its name and its fields.
struct CutLine {
  std::string name;
  std::vector<std::string> fields;
  std::string mark;  ///< of a continuation to come; empty for none
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
  const std::string mark = line.size() > behind ? capitals(line.substr(behind, small)) : "";
  CutLine cut{.name = capitals(trimmed(std::string_view(line).substr(0, small))),
              .fields = {},
              .mark = trimmed(mark).empty() ? "" : mark,
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
std::string mark_of(const std::vector<std::string>& words, std::size_t n_fields,
                    const std::string& place)
{
  if (words.size() <= n_fields + 1) return "";
  const std::string& mark = words[n_fields + 1];
  const bool is_number = mark.find_first_of("0123456789.-") == 0;
  const bool is_more = std::any_of(words.begin() + std::ptrdiff_t(n_fields) + 2, words.end(),
                                   [](const std::string& word) { return !word.empty(); });
  if (!is_number && !is_more) return mark;
  throw Error(
      fmt::format("{}: has more than {} fields behind its name; put the others on a "
                  "line that begins with a comma",
                  place, n_fields));
}

CutLine cut_free(const std::string& line, const std::string& place)
{
  std::vector<std::string> words = cut_at_commas(line);
  for (std::string& word : words) word = capitals(word);
  CutLine cut{.name = words.front(), .fields = {}, .mark = "", .is_large = false};
  cut.is_large = cut.name.find('*') != std::string::npos;
  const std::size_t n = cut.is_large ? 4 : 8;
  for (std::size_t i = 1; i <= n; ++i) cut.fields.push_back(i < words.size() ? words[i] : "");
  cut.mark = mark_of(words, n, place);
  return cut;
}

bool is_continuation(const CutLine& cut)
{
  return cut.name.empty() || cut.name.front() == '+' || cut.name.front() == '*';
}

/// What marks are compared by: columns 74 to 80 of a line and 2 to 8 of its continuation. Column 73
/// is free.
std::string compared(const std::string& mark)
{
  return trimmed(std::string_view(mark).substr(std::min<std::size_t>(mark.size(), 1)));
}

/// The same for marks in free fields, which may lack the sign in front.
std::string without_signs(std::string mark)
{
  std::erase_if(mark, [](char c) { return c == '+' || c == '*'; });
  return trimmed(mark);
}

bool is_continued_by(const std::string& mark, const std::string& name)
{
  return compared(mark) == compared(name) || without_signs(mark) == without_signs(name);
}

/// The lines of the bulk data, of which each may continue another one.
class BulkLines {
 public:
  void add(CutLine cut, const std::string& place)
  {
    lines_.push_back({.cut = std::move(cut), .place = place});
  }

  std::vector<Card> cards()
  {
    for (std::size_t i = 0; i < lines_.size(); ++i)
      if (is_continuation(lines_[i].cut)) continue_by(i);
    std::vector<Card> cards;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (is_continuation(lines_[i].cut)) continue;
      cards.emplace_back(without_signs(lines_[i].cut.name), lines_[i].place);
      for (std::size_t k = i; k != none; k = lines_[k].next)
        cards.back().append(lines_[k].cut.fields, lines_[k].cut.is_large ? 4 : 8);
    }
    return cards;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct Line {
    CutLine cut;
    std::string place;
    std::size_t next = none;  ///< the line that continues it
  };

  void continue_by(std::size_t i)
  {
    if (i == 0) throw Error(fmt::format("{}: continues no entry", lines_[i].place));
    Line& continued = lines_[continued_by(i)];
    if (continued.next != none) {
      throw Error(fmt::format("{}: continues {}, as {} does", lines_[i].place, continued.place,
                              lines_[continued.next].place));
    }
    continued.next = i;
  }

  /// The line before, unless another one ends with the mark.
  std::size_t continued_by(std::size_t i)
  {
    const std::string& name = lines_[i].cut.name;
    const std::string& mark = lines_[i - 1].cut.mark;
    if (without_signs(name).empty() || is_continued_by(mark, name)) return i - 1;
    if (with_mark_.empty()) find_marks();
    const auto [first, end] = with_mark_.equal_range(compared(name));
    if (first != end && std::next(first) == end) return first->second;
    if (first == end && mark.empty()) return i - 1;
    throw Error(fmt::format(
        "{}: the continuation {} stands behind a line that asks for {}, and {} with this mark",
        lines_[i].place, without_signs(name), mark.empty() ? "none" : without_signs(mark),
        first == end ? "there is no line" : "there are several lines"));
  }

  void find_marks()
  {
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const std::string& mark = lines_[k].cut.mark;
      if (mark.empty()) continue;
      with_mark_.emplace(compared(mark), k);
      if (without_signs(mark) != compared(mark)) with_mark_.emplace(without_signs(mark), k);
    }
  }

  std::vector<Line> lines_;
  std::multimap<std::string, std::size_t> with_mark_;  ///< lines by what they ask for
};

/// The file that INCLUDE names, with or without quotes.
std::string file_of_include_card(std::string_view line)
{
  constexpr std::string_view command = "INCLUDE";
  const std::string text = trimmed(line.substr(0, line.find('$')));
  if (capitals(text.substr(0, command.size())) != command) return "";
  const std::string file = trimmed(std::string_view(text).substr(command.size()));
  const bool is_quoted = file.size() > 2 && (file.front() == '\'' || file.front() == '"') &&
                         file.back() == file.front();
  return is_quoted ? file.substr(1, file.size() - 2) : file;
}

bool begins_bulk(std::string_view line)
{
  const std::string words = capitals(trimmed(line));
  return words.starts_with("BEGIN") && words.find("BULK") != std::string::npos;
}

/// The sets that case control chooses, from all subcases.
class CaseControl {
 public:
  void read(const DeckLine& line)
  {
    const std::string text = capitals(trimmed(line.text.substr(0, line.text.find('$'))));
    if (text == "CEND") has_end_ = true;
    if (const auto words = cut_at_commas(text); words.size() > 2 && words[0] == "PARAM") {
      parameters_.emplace_back("PARAM", line.place);
      parameters_.back().append({words[1], words[2]}, 2);
    }
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return;
    const std::string word = trimmed(std::string_view(text).substr(0, equals));
    if (word != "SPC" && word != "MPC") return;
    Card choice = card(word, trimmed(std::string_view(text).substr(equals + 1)), line.place);
    const auto [before, is_new] = chosen_.emplace(word, choice);
    if (is_new || before->second.field(2) == choice.field(2)) return;
    choice.refuse(fmt::format("{} chooses {} = {}; a scene is of one case: keep one SUBCASE",
                              before->second.place(), word, before->second.field(2)));
  }

  std::vector<Card> cards() const
  {
    std::vector<Card> all = parameters_;
    for (const char* word : {"SPC", "MPC"}) {
      const auto found = chosen_.find(word);
      if (found != chosen_.end()) all.push_back(found->second);
      if (found == chosen_.end() && has_end_) all.push_back(card(word, "", "case control"));
    }
    return all;
  }

 private:
  static Card card(const std::string& word, const std::string& set, const std::string& place)
  {
    Card choice("CASE", place);
    choice.append({word, set}, 2);
    return choice;
  }

  std::map<std::string, Card> chosen_;
  std::vector<Card> parameters_;
  bool has_end_ = false;
};

/// Blank fields of GRID have the values of GRDSET.
void fill_grids(std::vector<Card>& cards)
{
  const auto defaults = std::ranges::find(cards, "GRDSET", &Card::name);
  if (defaults == cards.end()) return;
  const auto second = std::find_if(std::next(defaults), cards.end(),
                                   [](const Card& card) { return card.name() == "GRDSET"; });
  if (second != cards.end()) second->refuse("there is one already; a deck has one at most");
  defaults->expect_no_more_than(8);
  const Card values = *defaults;
  for (Card& card : cards)
    if (card.name() == "GRID")
      for (const std::size_t i : {2, 6, 7}) card.fill(i, values.field(i));
}

}  // namespace

std::vector<Card> nastran_cards(const std::string& text, const ReadIncluded& read)
{
  const DeckLines lines(text, file_of_include_card, read);
  const bool has_begin =
      std::ranges::any_of(lines, [](const DeckLine& line) { return begins_bulk(line.text); });
  CaseControl control;
  BulkLines bulk;
  bool is_bulk = !has_begin;
  for (const DeckLine& whole : lines) {
    if (!is_bulk) {
      is_bulk = begins_bulk(whole.text);
      control.read(whole);
      continue;
    }
    const std::string unmarked = with_blanks(whole.text);
    const std::string line = unmarked.substr(0, unmarked.find('$'));
    const std::string start = capitals(trimmed(line)).substr(0, 7);
    if (start.empty()) continue;
    if (start == "ENDDATA") break;
    const bool is_free = line.find(',') != std::string::npos;
    bulk.add(is_free ? cut_free(line, whole.place) : cut_fixed(line), whole.place);
  }
  std::vector<Card> cards = control.cards();
  std::ranges::move(bulk.cards(), std::back_inserter(cards));
  fill_grids(cards);
  return cards;
}

namespace {

constexpr std::int64_t greatest_number = 2'147'483'647;

/// As C++ writes a number: Nastran leaves out the letter of an exponent, or writes D.
std::string with_exponent(std::string_view field)
{
  std::string text;
  for (const char c : field) {
    const bool is_sign = c == '+' || c == '-';
    if (is_sign && !text.empty() && text.back() != 'e') text += 'e';
    const bool is_exponent = c == 'D' || c == 'd' || c == 'E' || c == 'e';
    text += is_exponent ? 'e' : c;
  }
  if (text.starts_with('+')) text.erase(0, 1);
  const std::size_t plus = text.find("e+");
  if (plus != std::string::npos) text.erase(plus + 1, 1);
  return text;
}

}  // namespace

std::string_view Card::field(std::size_t i) const
{
  return i >= 1 && i <= fields_.size() ? std::string_view(fields_[i - 1]) : std::string_view();
}

void Card::refuse(std::string_view why) const
{
  throw Error(fmt::format("{}: {} {}: {}", place_, name_, field(1), why));
}

std::int64_t Card::integer(std::size_t i, std::string_view what) const
{
  const std::string_view text = field(i);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= 0 &&
      value <= greatest_number)
    return value;
  refuse(fmt::format("\"{}\" in field {} is no {}; that is a number from 0 to {}", text, i + 1,
                     what, greatest_number));
}

std::int64_t Card::integer_or(std::size_t i, std::string_view what, std::int64_t otherwise) const
{
  return has(i) ? integer(i, what) : otherwise;
}

double Card::real(std::size_t i, std::string_view what) const
{
  const std::string text = with_exponent(field(i));
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value))
    return value;
  refuse(fmt::format("\"{}\" in field {} is no number, which {} is", field(i), i + 1, what));
}

double Card::real_or(std::size_t i, std::string_view what, double otherwise) const
{
  return has(i) ? real(i, what) : otherwise;
}

std::array<double, 3> Card::vector_or_zero(std::size_t first, std::string_view what) const
{
  return {real_or(first, what, 0.0), real_or(first + 1, what, 0.0), real_or(first + 2, what, 0.0)};
}

std::vector<int> Card::components(std::size_t i) const
{
  std::vector<int> found;
  for (const char c : field(i)) {
    if (c < '1' || c > '6')
      refuse(fmt::format("\"{}\" in field {} are no components of 1 to 6", field(i), i + 1));
    found.push_back(c - '1');
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<NumberRange> Card::ranges(std::size_t first, std::string_view what) const
{
  std::vector<NumberRange> ranges;
  for (std::size_t i = first; i <= n_fields(); ++i) {
    if (!has(i)) continue;
    if (field(i) != "THRU") {
      const std::int64_t number = integer(i, what);
      ranges.push_back({.from = number, .to = number, .step = 1});
      continue;
    }
    if (ranges.empty() || ranges.back().from != ranges.back().to)
      refuse("THRU has no number before it");
    NumberRange& range = ranges.back();
    range.to = integer(++i, what);
    if (field(i + 1) == "BY") {
      range.step = integer(i + 2, "step");
      i += 2;
    }
    if (range.step < 1 || range.to <= range.from) {
      refuse(
          fmt::format("{} THRU {} BY {} is no range of numbers", range.from, range.to, range.step));
    }
  }
  return ranges;
}

void Card::expect_blank(std::size_t first, std::size_t last, std::string_view why) const
{
  for (std::size_t i = first; i <= last; ++i)
    if (has(i)) refuse(fmt::format("\"{}\" in field {}: {}", field(i), i + 1, why));
}

void Card::expect_no_more_than(std::size_t n) const
{
  expect_blank(n + 1, std::max(n + 1, n_fields()), "nothing is known of this field");
}

void Card::fill(std::size_t i, std::string_view value)
{
  if (fields_.size() < i) fields_.resize(i);
  if (fields_[i - 1].empty()) fields_[i - 1] = value;
}

void Card::append(const std::vector<std::string>& fields, std::size_t width)
{
  while (fields_.size() % width != 0) fields_.emplace_back();
  fields_.insert(fields_.end(), fields.begin(), fields.end());
}

}  // namespace chladni::mesh
