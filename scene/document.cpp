#include "scene/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "scene/keys.hpp"

namespace chladni::scene {

namespace {

/// A check of a value: it returns what is wrong, or an empty text.
using Objection = std::function<std::string(const toml::node&)>;

/// A value as text for a message, on one line; strings are shown in full, other values with at most
/// 60 characters.
std::string value_text(const toml::node& value)
{
  if (const auto* text = value.as_string()) return fmt::format("\"{}\"", text->get());
  if (const auto* number = value.as_floating_point()) return fmt::format("{}", number->get());
  std::ostringstream stream;
  stream << toml::toml_formatter(value);
  std::string text = stream.str();
  std::ranges::replace(text, '\n', ' ');
  return text.size() <= 60 ? text : text.substr(0, 60) + " ...";
}

Objection objection_to_number(const Admissible& admissible)
{
  return [admissible](const toml::node& value) -> std::string {
    if (!value.is_number()) return "must be " + requirement(admissible, "a number");
    const bool admitted = admits(admissible, *value.value<double>());
    return admitted ? "" : "must be " + requirement(admissible);
  };
}

Objection objection_to_integer(const Admissible& admissible)
{
  return [admissible](const toml::node& value) -> std::string {
    if (!value.is_integer()) return "must be " + requirement(admissible, "a whole number");
    if (!value.value<int>()) return "is too large";
    return objection_to_number(admissible)(value);
  };
}

std::string objection_to_truth(const toml::node& value)
{
  return value.is_boolean() ? "" : "must be true or false";
}

std::string objection_to_text(const toml::node& value)
{
  if (!value.is_string()) return "must be a text in quotes";
  return value.as_string()->get().empty() ? "must not be empty" : "";
}

}  // namespace

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

void Table::Node::note_unusual(std::string_view key, double x, const Admissible& admissible)
{
  const bool is_unit = x == 1.0;  // chosen on purpose: a section then has stiffness and mass
  if (is_unit || (x >= admissible.usual_from && x <= admissible.usual_to)) return;
  std::string note =
      fmt::format("{} is unusual: {}", said(*table->get(key), path_of(key)), admissible.usually);
  if (!contains(whole->notes, note)) whole->notes.push_back(std::move(note));
}

void Table::Node::refuse_slip(std::string_view key) const
{
  const std::string slip = nearest_name(key, keys_not_asked());
  if (slip.empty()) return;
  throw Error(at(line_of_key(slip)) +
              fmt::format("{} is not a key here; did you mean {}?", path_of(slip), key));
}

const toml::node& Table::Node::require(std::string_view key, std::string_view kind)
{
  if (const toml::node* value = find(key)) return *value;
  refuse_slip(key);
  const std::string place = path.empty() ? file + ": " : at(table->source().begin.line);
  throw Error(place + fmt::format("{} is missing: must be {}", path_of(key), kind));
}

Table::Node::MessagesByLine Table::Node::unknown_keys() const
{
  const std::vector<std::string> allowed(asked.begin(), asked.end());
  MessagesByLine unknown;
  for (const std::string& key : keys_not_asked()) {
    const auto line = line_of_key(key);
    const std::string near = nearest_name(key, allowed);
    const std::string hint = near.empty() ? "" : fmt::format(" did you mean {}?", near);
    unknown.emplace(line, fmt::format("{}{} is not a key here;{} allowed: {}", at(line),
                                      path_of(key), hint, fmt::join(allowed, ", ")));
  }
  for (const auto& inner : opened) unknown.merge(inner->unknown_keys());
  return unknown;
}

std::shared_ptr<Table::Node> Table::Node::open(const toml::table& inner, std::string_view key,
                                               std::string inner_path)
{
  for (const auto& node : opened)
    if (node->table == &inner) return node;
  return opened.emplace_back(std::make_shared<Node>(
      Node{whole, file, std::move(inner_path), row_of(key), &inner, {}, {}}));
}

void Table::Node::refuse(const toml::node& value, std::string_view value_path,
                         std::string_view why) const
{
  throw Error(fmt::format("{}: {}", said(value, value_path), why));
}

bool Table::has(std::string_view key) const
{
  return node_->find(key) != nullptr;
}

bool Table::is_number(std::string_view key) const
{
  return node_->require(key, "a value").is_number();
}

bool Table::is_list(std::string_view key) const
{
  return node_->require(key, "a value").is_array();
}

bool Table::is_table(std::string_view key) const
{
  return node_->require(key, "a value").is_table();
}

bool Table::is_text(std::string_view key) const
{
  return node_->require(key, "a value").is_string();
}

double Table::number(std::string_view key, const Admissible& further) const
{
  const Admissible admissible = node_->admitted(key, further);
  const double x = node_->value<double>(key, requirement(admissible, "a number"),
                                        objection_to_number(admissible));
  node_->note_unusual(key, x, admissible);
  return x;
}

int Table::integer(std::string_view key, const Admissible& further) const
{
  const Admissible admissible = node_->admitted(key, further);
  return node_->value<int>(key, requirement(admissible, "a whole number"),
                           objection_to_integer(admissible));
}

std::string Table::text(std::string_view key) const
{
  return node_->value<std::string>(key, "a text in quotes", objection_to_text);
}

void Table::check_word(std::string_view key, const std::string& word) const
{
  const Key* known = find_key(node_->row_of(key));
  if (known == nullptr || known->words.empty()) return;
  const std::vector<std::string> words = words_of(*known);
  if (!contains(words, word)) refuse(key, "must be one of " + quoted_list(words));
}

bool Table::truth(std::string_view key) const
{
  return node_->value<bool>(key, "true or false", objection_to_truth);
}

std::vector<double> Table::numbers(std::string_view key, const Admissible& further) const
{
  const Admissible admissible = node_->admitted(key, further);
  return node_->elements<double>(key, "a list of numbers", objection_to_number(admissible));
}

std::vector<int> Table::integers(std::string_view key, const Admissible& further) const
{
  const Admissible admissible = node_->admitted(key, further);
  return node_->elements<int>(key, "a list of whole numbers", objection_to_integer(admissible));
}

std::vector<std::string> Table::texts(std::string_view key) const
{
  return node_->elements<std::string>(key, "a list of texts in quotes", objection_to_text);
}

std::string_view Table::only_one_of(std::initializer_list<std::string_view> keys) const
{
  std::vector<std::string_view> present;
  for (const std::string_view key : keys)
    if (has(key)) present.push_back(key);
  if (present.size() == 1) return present.front();
  const std::string wanted = fmt::format("give exactly one of {}", fmt::join(keys, ", "));
  if (present.size() > 1) refuse(present[1], wanted);
  for (const std::string_view key : keys) node_->refuse_slip(key);
  node_->refuse(*node_->table, node_->path, wanted);
}

Table Table::table(std::string_view key) const
{
  const toml::node& value = node_->require(key, "a table");
  if (!value.is_table()) refuse(key, "must be a table");
  return Table(node_->open(*value.as_table(), key, node_->path_of(key)));
}

std::vector<Table> Table::tables(std::string_view key) const
{
  const toml::node& value = node_->require(key, "a list of tables");
  if (!value.is_array()) refuse(key, "must be a list of tables");
  const toml::array& array = *value.as_array();
  std::vector<Table> tables;
  for (const toml::node& element : array) {
    const std::string element_path =
        array.size() == 1 ? node_->path_of(key) : node_->element_path_of(key, tables.size());
    if (!element.is_table()) node_->refuse(element, element_path, "must be a table");
    tables.push_back(Table(node_->open(*element.as_table(), key, element_path)));
  }
  return tables;
}

std::vector<std::string> Table::names() const
{
  std::vector<std::string> names;
  for (const auto& [key, value] : *node_->table) names.emplace_back(key.str());
  return names;
}

std::vector<std::string> Table::notes() const
{
  return node_->whole->notes;
}

void Table::refuse(std::string_view key, std::string_view why) const
{
  node_->refuse(*node_->find(key), node_->path_of(key), why);
}

void Table::refuse_element(std::string_view key, std::size_t i, std::string_view why) const
{
  node_->refuse(*node_->find(key)->as_array()->get(i), node_->element_path_of(key, i), why);
}

void Table::refuse_unknown_keys() const
{
  std::string message;
  for (const auto& [line, text] : node_->unknown_keys())
    message += (message.empty() ? "" : "\n") + text;
  if (!message.empty()) throw Error(message);
}

Table parse_toml(const std::string& text, const std::string& file)
{
  try {
    const auto whole = std::make_shared<Table::Node::File>(
        Table::Node::File{.table = parse_values(text, file), .notes = {}});
    return Table(
        std::make_shared<Table::Node>(Table::Node{whole, file, {}, {}, &whole->table, {}, {}}));
  } catch (const toml::parse_error& error) {
    throw Error(fmt::format("{}:{}: {}", file, error.source().begin.line, error.description()));
  }
}

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
