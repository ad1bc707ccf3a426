#include "scene/keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace chladni::scene {

namespace {

using Rows = std::span<const Key>;

std::array<Rows, 8> all_rows()
{
  return {mesh_keys(),   model_keys(), reduction_keys(), response_keys(),
          squeal_keys(), brake_keys(), assembly_keys(),  sound_keys()};
}

/// Splits "a.b.c" into "a" and "b.c".
std::pair<std::string_view, std::string_view> first_part(std::string_view path)
{
  const auto dot = path.find('.');
  if (dot == std::string_view::npos) return {path, {}};
  return {path.substr(0, dot), path.substr(dot + 1)};
}

bool matches(std::string_view row, std::string_view path)
{
  while (!row.empty() && !path.empty()) {
    const auto [row_head, row_rest] = first_part(row);
    const auto [path_head, path_rest] = first_part(path);
    if (row_head != path_head && row_head != "*") return false;
    row = row_rest;
    path = path_rest;
  }
  return row.empty() && path.empty();
}

std::string_view name_of(KeyKind kind)
{
  switch (kind) {
    case KeyKind::number:
      return "number";
    case KeyKind::numbers:
      return "list of numbers";
    case KeyKind::integer:
      return "whole number";
    case KeyKind::integers:
      return "list of whole numbers";
    case KeyKind::text:
      return "text";
    case KeyKind::texts:
      return "list of texts";
    case KeyKind::truth:
      return "true or false";
    case KeyKind::word:
      return "word";
    case KeyKind::table:
      return "table";
    case KeyKind::tables:
      return "list of tables";
  }
  return "";
}

/// `> 0`, or the words; for a cell of a table.
std::string range_of(const Key& key)
{
  if (!key.words.empty()) {
    std::string words;
    for (const char c : key.words) words += c == '|' ? std::string("\\|") : std::string(1, c);
    return words;
  }
  Admissible bounds = key.admits;
  bounds.unit = {};
  const std::string text = requirement(bounds);
  return text == "finite" ? "" : text;
}

std::string row_text(const Key& key)
{
  return fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.path, name_of(key.kind),
                     key.admits.unit, range_of(key), key.absent, key.meaning);
}

std::string table_text(std::string_view heading, Rows rows)
{
  std::string text = fmt::format(
      "\n## {}\n\n| key | type | unit | range | without it | meaning |\n"
      "| --- | --- | --- | --- | --- | --- |\n",
      heading);
  for (const Key& key : rows) text += row_text(key);
  return text;
}

}  // namespace

const Key* find_key(std::string_view path)
{
  for (const Rows rows : all_rows()) {
    for (const Key& key : rows)
      if (matches(key.path, path)) return &key;
  }
  return nullptr;
}

std::vector<std::string> words_of(const Key& key)
{
  std::vector<std::string> words;
  for (std::string_view rest = key.words; !rest.empty();) {
    const auto bar = rest.find(" | ");
    words.emplace_back(rest.substr(0, bar));
    rest = bar == std::string_view::npos ? std::string_view() : rest.substr(bar + 3);
  }
  return words;
}

std::string scene_reference()
{
  constexpr std::string_view preface = R"(# Scene reference

Every key of a scene file, SI units. `squeal scene-reference` prints this page from the table by which the programs check a
scene; a test fails when it is not up to date (`squeal scene-reference > docs/reference/scene.md`).

A key of an inner table stands as `outer.inner`; a list of tables is written `[[outer]]` or `outer = [{ ... }]`; `*` is a name
that you choose, or each of several. What must hold between keys is said by the message that a scene with a mistake gets.
)";
  return std::string(preface) + table_text("The scene and its mesh", mesh_keys()) +
         table_text("Materials, sections, couplings, loads", model_keys()) +
         table_text("Reduction and body", reduction_keys()) +
         table_text("Frequency responses", response_keys()) +
         table_text("Squeal: study and analyses", squeal_keys()) +
         table_text("Squeal: friction, pads and models without a body", brake_keys()) +
         table_text("Squeal: assemblies of several bodies", assembly_keys()) +
         table_text("Sound", sound_keys());
}

bool admits(const Admissible& admissible, double x)
{
  return std::isfinite(x) && x > admissible.above && x >= admissible.at_least &&
         x < admissible.below && x <= admissible.at_most;
}

Admissible both(const Admissible& a, const Admissible& b)
{
  return {.above = std::max(a.above, b.above),
          .at_least = std::max(a.at_least, b.at_least),
          .below = std::min(a.below, b.below),
          .at_most = std::min(a.at_most, b.at_most),
          .unit = b.unit.empty() ? a.unit : b.unit,
          .usual_from = std::max(a.usual_from, b.usual_from),
          .usual_to = std::min(a.usual_to, b.usual_to),
          .usually = b.usually.empty() ? a.usually : b.usually};
}

std::string requirement(const Admissible& admissible, std::string_view kind)
{
  std::vector<std::string> bounds;
  const auto add_bound = [&](std::string_view relation, double bound) {
    if (std::isfinite(bound)) bounds.push_back(fmt::format("{} {}", relation, bound));
  };
  // Of two bounds on one side the weaker one says nothing.
  if (admissible.above >= admissible.at_least) add_bound(">", admissible.above);
  if (admissible.at_least > admissible.above) add_bound(">=", admissible.at_least);
  if (admissible.below <= admissible.at_most) add_bound("<", admissible.below);
  if (admissible.at_most < admissible.below) add_bound("<=", admissible.at_most);

  std::string text{kind};
  if (!bounds.empty())
    text += fmt::format("{}{}", text.empty() ? "" : " ", fmt::join(bounds, " and "));
  if (text.empty()) text = "finite";
  if (!admissible.unit.empty()) text += fmt::format(" ({})", admissible.unit);
  return text;
}

namespace {

/// Levenshtein: the fewest insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

bool contains(const std::vector<std::string>& names, std::string_view name)
{
  return std::ranges::find(names, name) != names.end();
}

std::string quoted_list(const std::vector<std::string>& names)
{
  std::string text;
  for (const std::string& name : names)
    text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
  return text.empty() ? "(none)" : text;
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& names)
{
  std::string nearest;
  std::size_t least = name.size() < 4 ? 2 : 3;  // one more than the slips that are forgiven
  for (const std::string& candidate : names) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string no_such_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string>& names)
{
  const std::string near = nearest_name(name, names);
  const std::string hint = near.empty() ? "" : fmt::format(" did you mean \"{}\"?", near);
  constexpr std::size_t most = 30;  // the curves of a .step may be hundreds
  const auto n_listed = static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  const std::string more =
      names.size() > most ? fmt::format(" and {} more", names.size() - most) : "";
  return fmt::format("no such {} in the scene;{} there are: {}{}", kind, hint,
                     quoted_list({names.begin(), names.begin() + n_listed}), more);
}

}  // namespace chladni::scene
