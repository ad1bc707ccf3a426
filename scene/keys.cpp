#include "scene/keys.hpp"

#include <fmt/format.h>

#include <array>

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

}  // namespace chladni::scene
