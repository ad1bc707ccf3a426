#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "scene/document.hpp"
#include "scene/document_values.hpp"
#include "scene/keys.hpp"

namespace chladni::scene {

/// A table of the file as toml++ parsed it, with the keys that were read.
struct Table::Node {
  using MessagesByLine = std::multimap<toml::source_index, std::string>;

  /// Data that all tables of a file share.
  struct File {
    toml::table table;  ///< keeps all nodes alive
    std::vector<std::string> notes;
  };
  std::shared_ptr<File> whole;
  std::string file;
  std::string path;  ///< path of the table's key; empty for the root
  std::string row;   ///< the path without list indices, as in the rows of keys.hpp
  const toml::table* table;
  std::set<std::string, std::less<>> asked;
  std::vector<std::shared_ptr<Node>> opened;

  /// Path of a key of this table.
  std::string path_of(std::string_view key) const
  {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }
  std::string element_path_of(std::string_view key, std::size_t i) const
  {
    return fmt::format("{}[{}]", path_of(key), i + 1);
  }
  std::string at(toml::source_index line) const { return fmt::format("{}:{}: ", file, line); }
  /// The value at `key` or null; records that the key was read.
  const toml::node* find(std::string_view key)
  {
    asked.emplace(key);
    return table->get(key);
  }
  MessagesByLine unknown_keys() const;
  /// The keys of this table that were not read.
  std::vector<std::string> keys_not_asked() const
  {
    std::vector<std::string> keys;
    for (const auto& [key, value] : *table)
      if (!asked.contains(key.str())) keys.emplace_back(key.str());
    return keys;
  }
  toml::source_index line_of_key(std::string_view key) const
  {
    return table->find(key)->first.source().begin.line;
  }
  /// Refuses a key that was not read and looks like a misspelling of the missing `key`.
  void refuse_slip(std::string_view key) const;
  /// The value at `key`.
  /// @throws chladni::Error when it is missing.
  const toml::node& require(std::string_view key, std::string_view kind);
  std::shared_ptr<Node> open(const toml::table& inner, std::string_view key,
                             std::string inner_path);
  std::string row_of(std::string_view key) const
  {
    return row.empty() ? std::string(key) : fmt::format("{}.{}", row, key);
  }
  /// What both the key's row and the reader accept.
  Admissible admitted(std::string_view key, const Admissible& further) const
  {
    const Key* known = find_key(row_of(key));
    return known != nullptr ? both(known->admits, further) : further;
  }
  /// The value at `key`.
  /// @param objection  says what is wrong with the value; empty if nothing
  template <class T>
  T value(std::string_view key, std::string_view kind, const Objection& objection);
  /// The list at `key`.
  /// @param objection  says what is wrong with an element; empty if nothing
  template <class T>
  std::vector<T> elements(std::string_view key, std::string_view kind, const Objection& objection);
  [[noreturn]] void refuse(const toml::node& value, std::string_view value_path,
                           std::string_view why) const;
  /// Place and value for a message: "scene.toml:3: mesh.width = 3".
  std::string said(const toml::node& value, std::string_view value_path) const
  {
    const std::string text = value.is_table() ? "" : " = " + value_text(value);
    return at(value.source().begin.line) + std::string(value_path) + text;
  }
  void note_unusual(std::string_view key, double x, const Admissible& admissible);
};

template <class T>
T Table::Node::value(std::string_view key, std::string_view kind, const Objection& objection)
{
  const toml::node& found = require(key, kind);
  const std::string why = objection(found);
  if (!why.empty()) refuse(found, path_of(key), why);
  return *found.value<T>();
}

template <class T>
std::vector<T> Table::Node::elements(std::string_view key, std::string_view kind,
                                     const Objection& objection)
{
  const toml::node& list = require(key, kind);
  if (!list.is_array()) refuse(list, path_of(key), fmt::format("must be {} in [ ]", kind));
  std::vector<T> values;
  for (const toml::node& element : *list.as_array()) {
    const std::string why = objection(element);
    if (!why.empty()) refuse(element, element_path_of(key, values.size()), why);
    values.push_back(*element.value<T>());
  }
  return values;
}

}  // namespace chladni::scene
