#include "mesh/decks/abaqus_keywords.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>

#include "common/error.hpp"
#include "mesh/decks/abaqus.hpp"
#include "mesh/decks/deck_text.hpp"

namespace chladni::mesh {
namespace {

std::string unquoted(std::string text)
{
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    return text.substr(1, text.size() - 2);
  return text;
}

/// Blanks in a keyword are one space each.
std::string with_single_blanks(const std::string& text)
{
  std::string words;
  for (const char c : text)
    if (c != ' ' && c != '\t')
      words += c;
    else if (words.empty() || words.back() != ' ')
      words += ' ';
  return words;
}

void add_parameters(Keyword& keyword, std::span<const std::string> words)
{
  for (const std::string& word : words) {
    if (word.empty()) continue;
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string_view text(word);
    const std::string value =
        equals < word.size() ? unquoted(capitals(trimmed(text.substr(equals + 1)))) : "";
    const std::string name = capitals(with_single_blanks(trimmed(text.substr(0, equals))));
    const bool is_node = name == "REFNODE" || name == "ROTNODE";  // as CalculiX reads them too
    keyword.parameters[is_node ? name.substr(0, 3) + " NODE" : name] = value;
  }
}

Keyword keyword_of(const DeckLine& line, const std::string& text)
{
  const std::vector<std::string> words = cut_at_commas(std::string_view(text).substr(1));
  Keyword keyword{.name = capitals(with_single_blanks(words.front())),
                  .place = line.place,
                  .parameters = {},
                  .rows = {}};
  add_parameters(keyword, std::span(words).subspan(1));
  return keyword;
}

/// Whether a line behind a keyword that ends with a comma has more of its parameters; some programs
/// write the comma without any.
bool has_parameters(const std::string& line)
{
  static const std::set<std::string> flags{"GENERATE",     "INTERNAL", "UNSORTED", "COMPOSITE",
                                           "PERTURBATION", "NLGEOM",   "SYMMETRIC"};
  return std::ranges::all_of(cut_at_commas(line), [](const std::string& word) {
    return word.empty() || word.find('=') != std::string::npos || flags.contains(capitals(word));
  });
}

KeywordRow row_of(const DeckLine& line)
{
  std::vector<std::string> fields = cut_at_commas(line.text);
  for (std::string& field : fields) field = unquoted(capitals(field));
  return {.place = line.place, .fields = std::move(fields)};
}

/// The file that *INCLUDE, INPUT = FILE names.
std::string file_of_include(std::string_view line)
{
  const std::string text = trimmed(line);
  if (text.size() < 2 || text.front() != '*' || text[1] == '*') return "";
  const std::vector<std::string> words = cut_at_commas(std::string_view(text).substr(1));
  if (capitals(words.front()) != "INCLUDE") return "";
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) continue;
    if (capitals(trimmed(std::string_view(word).substr(0, equals))) == "INPUT")
      return unquoted(trimmed(std::string_view(word).substr(equals + 1)));
  }
  return "";
}

std::vector<Keyword> parsed(const DeckLines& lines)
{
  std::vector<Keyword> keywords;
  bool may_go_on = false;  // the line of a keyword that ends with a comma
  for (const DeckLine& line : lines) {
    const std::string text = trimmed(line.text);
    if (text.empty() || text.starts_with("**")) continue;
    if (text.starts_with('*')) {
      keywords.push_back(keyword_of(line, text));
    } else if (keywords.empty()) {
      throw Error(fmt::format("{}: stands before the first keyword", line.place));
    } else if (may_go_on && has_parameters(text)) {
      add_parameters(keywords.back(), cut_at_commas(text));
    } else {
      keywords.back().rows.push_back(row_of(line));
      may_go_on = false;
      continue;
    }
    may_go_on = text.back() == ',';
  }
  return keywords;
}

bool is_support_anew(const Keyword& keyword)
{
  return keyword.name == "BOUNDARY" && keyword.has("OP") && keyword.parameter("OP") == "NEW";
}

/// Pre-processors write supports into the first step; they are the model's. OP = NEW takes away
/// those before the step.
std::vector<Keyword> with_first_step(std::vector<Keyword> keywords)
{
  const auto step = std::ranges::find(keywords, "STEP", &Keyword::name);
  const auto end = std::find_if(step, keywords.end(),
                                [](const Keyword& keyword) { return keyword.name == "END STEP"; });
  std::vector<Keyword> model(keywords.begin(), step), of_step;
  if (std::any_of(step, end, is_support_anew))
    std::erase_if(model, [](const Keyword& keyword) { return keyword.name == "BOUNDARY"; });
  for (auto keyword = step; keyword != end; ++keyword) {
    if (keyword->name == "MODEL CHANGE")
      keyword->refuse("takes elements out or in; write the model as it is in the analysis");
    const bool is_of_model =
        keyword->name == "BOUNDARY" || keyword->name == "NSET" || keyword->name == "ELSET";
    (is_of_model ? model : of_step).push_back(*keyword);
    if (keyword->name == "BOUNDARY") model.back().parameters.erase("OP");
  }
  std::ranges::move(of_step, std::back_inserter(model));
  std::move(end, keywords.end(), std::back_inserter(model));
  return model;
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
  throw Error(fmt::format("{}: *{}: {}", place, name, why));
}

void Keyword::refuse(const KeywordRow& row, std::string_view why) const
{
  throw Error(fmt::format("{}: *{}: {}", row.place, name, why));
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

namespace {

/// A row of *BOUNDARY that holds a ROT NODE, as one that holds rotations of its REF NODE.
KeywordRow of_rotations(const Keyword& keyword, KeywordRow row, const std::string& reference)
{
  row.fields.front() = reference;
  for (std::size_t i = 1; i < std::min<std::size_t>(row.fields.size(), 3); ++i) {
    if (row.fields[i].empty()) continue;
    const std::int64_t component = keyword.integer(row, i, "component");
    if (component > 3) keyword.refuse(row, "a ROT NODE has the components 1 to 3");
    row.fields[i] = fmt::format("{}", component + 3);
  }
  return row;
}

/// The displacements of the node ROT NODE of a rigid body are the rotations of its REF NODE.
std::vector<Keyword> with_rotations(std::vector<Keyword> keywords)
{
  const auto has_rotations = [](const Keyword& keyword) {
    return keyword.name == "RIGID BODY" && keyword.has("ROT NODE");
  };
  if (std::ranges::none_of(keywords, has_rotations)) return keywords;
  const AbaqusSets sets = abaqus_sets(keywords);
  std::map<std::int64_t, std::string> reference_of;
  for (const Keyword& keyword : keywords)
    if (has_rotations(keyword)) {
      for (const std::int64_t node :
           abaqus_nodes(keyword, {keyword.place, {}}, keyword.parameter("ROT NODE"), sets))
        reference_of[node] = keyword.parameter("REF NODE");
    }
  for (std::size_t i = 0, n = abaqus_model(keywords).size(); i < n; ++i) {
    Keyword& keyword = keywords[i];
    if (keyword.name != "BOUNDARY") continue;
    std::vector<KeywordRow> rows;
    for (const KeywordRow& row : keyword.rows) {
      const std::vector<std::int64_t> nodes = abaqus_nodes(keyword, row, row.fields.front(), sets);
      const auto n_rotations =
          std::ranges::count_if(nodes, [&](auto node) { return reference_of.contains(node); });
      if (n_rotations == 0) {
        rows.push_back(row);
        continue;
      }
      if (n_rotations < std::ssize(nodes))
        keyword.refuse(row, "holds a ROT NODE among others; hold it on a line of its own");
      for (const std::int64_t node : nodes)
        rows.push_back(of_rotations(keyword, row, reference_of.at(node)));
    }
    keyword.rows = std::move(rows);
  }
  return keywords;
}

}  // namespace

std::vector<Keyword> abaqus_keywords(const std::string& text, const ReadIncluded& read)
{
  return with_rotations(
      flat_keywords(with_first_step(parsed(DeckLines(text, file_of_include, read)))));
}

}  // namespace chladni::mesh
