#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cli/scene/document.hpp"

namespace chladni::cli {

using Objection = std::function<std::string(const toml::node&)>;
using MessagesByLine = std::multimap<toml::source_index, std::string>;

/// A table of the file, with what was asked of it.
struct Table::Node {
  std::shared_ptr<const toml::table> file_table;  ///< keeps all nodes of the file alive
  std::string file;
  std::string path;  ///< of keys; empty for the root
  const toml::table* table;
  std::set<std::string, std::less<>> asked;
  std::vector<std::shared_ptr<Node>> opened;

  std::string path_of(std::string_view key) const
  {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }
  std::string element_path_of(std::string_view key, std::size_t i) const
  {
    return fmt::format("{}[{}]", path_of(key), i + 1);
  }
  std::string at(toml::source_index line) const { return fmt::format("{}:{}: ", file, line); }
  const toml::node* find(std::string_view key)
  {
    asked.emplace(key);
    return table->get(key);
  }
  MessagesByLine unknown_keys() const;
  std::vector<std::string> keys_not_asked() const
  {
    std::vector<std::string> keys;
    for (const auto& [key, value] : *table) {
      if (!asked.contains(key.str())) keys.emplace_back(key.str());
    }
    return keys;
  }
  toml::source_index line_of_key(std::string_view key) const
  {
    return table->find(key)->first.source().begin.line;
  }
  /// Throws when a key that nobody asked for looks like a slip for the missing `key`.
  void refuse_slip(std::string_view key) const;
  const toml::node& require(std::string_view key, std::string_view kind);
  std::shared_ptr<Node> open(const toml::table& inner, std::string inner_path);
  /// The value at `key`; `objection` says what is wrong with it, or nothing.
  template <class T>
  T value(std::string_view key, std::string_view kind, const Objection& objection);
  /// The list at `key`; `objection` says what is wrong with an element, or nothing.
  template <class T>
  std::vector<T> elements(std::string_view key, std::string_view kind, const Objection& objection);
  [[noreturn]] void refuse(const toml::node& value, std::string_view value_path,
                           std::string_view why) const;
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

}  // namespace chladni::cli
