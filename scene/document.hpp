#pragma once

#include <toml++/toml.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/keys.hpp"

namespace chladni::scene {

/// A word that a key accepts, and its value.
template <class T>
struct Choice {
  std::string_view name;
  T value;
};

/// A table of a TOML file. It knows its place in the file, so that errors name file, line, key and
/// value. It records which keys were read, so that unknown keys can be refused; copies share this
/// record. In key paths the tables of an array count from 1.
/// All reading functions throw chladni::Error when the key is missing or its value is not accepted.
class Table {
 public:
  bool has(std::string_view key) const;
  bool is_number(std::string_view key) const;
  bool is_list(std::string_view key) const;
  bool is_table(std::string_view key) const;
  bool is_text(std::string_view key) const;
  /// A number, checked by the key's row in keys.hpp and by `further`, which may depend on other
  /// keys.
  double number(std::string_view key, const Admissible& further = {}) const;
  int integer(std::string_view key, const Admissible& further = {}) const;
  std::string text(std::string_view key) const;
  bool truth(std::string_view key) const;
  std::vector<double> numbers(std::string_view key, const Admissible& further = {}) const;
  std::vector<int> integers(std::string_view key, const Admissible& further = {}) const;
  std::vector<std::string> texts(std::string_view key) const;

  /// The key of this list that the table contains.
  /// @throws chladni::Error when it contains none or several of them.
  std::string_view only_one_of(std::initializer_list<std::string_view> keys) const;

  /// The value of the word at `key`.
  /// @throws chladni::Error listing the allowed words.
  template <class T>
  T choice(std::string_view key, const std::vector<Choice<T>>& choices) const;

  /// The table `key = {...}` or `[key]`.
  Table table(std::string_view key) const;
  /// The tables `[[key]]` or `key = [{...}, ...]`.
  std::vector<Table> tables(std::string_view key) const;
  /// All keys of the table in alphabetic order, for names that the user chooses, as in
  /// `[material.NAME]`.
  std::vector<std::string> names() const;

  /// Throws `FILE:LINE: PATH.key = VALUE: why`.
  [[noreturn]] void refuse(std::string_view key, std::string_view why) const;
  /// Throws `FILE:LINE: PATH.key[i+1] = VALUE: why`; `i` counts from 0.
  [[noreturn]] void refuse_element(std::string_view key, std::size_t i, std::string_view why) const;

  /// A line for each number read from the file, in this or any other table, that is accepted but
  /// unusual: `FILE:LINE: PATH.key = VALUE is unusual: ...`.
  std::vector<std::string> notes() const;

  /// Refuses unknown keys.
  /// @throws chladni::Error listing every key that was not read, in this table and in those opened
  ///         from it, and the keys that are allowed in its place.
  void refuse_unknown_keys() const;

 private:
  /// Refuses a word that the key's row does not list.
  void check_word(std::string_view key, const std::string& word) const;

  struct Node;
  explicit Table(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  friend Table parse_toml(const std::string& text, const std::string& file);

  std::shared_ptr<Node> node_;
};

/// The root table of a TOML text; `file` is its name in messages.
/// @throws chladni::Error with file and line when the text is not TOML.
Table parse_toml(const std::string& text, const std::string& file);

template <class T>
T Table::choice(std::string_view key, const std::vector<Choice<T>>& choices) const
{
  const std::string name = text(key);
  check_word(key, name);
  std::vector<std::string> names;
  for (const Choice<T>& choice : choices) {
    if (choice.name == name) return choice.value;
    names.emplace_back(choice.name);
  }
  refuse(key, "must be one of " + quoted_list(names));
}

/// Largest number of parts of a dotted key or of a table's name.
inline constexpr int key_parts_max = 16;

/// Parses a TOML text with limited nesting.
/// @param file  name of the file in error messages
/// @throws toml::parse_error when the text is not TOML; chladni::Error when a key has more than
///         `key_parts_max` parts, because toml++ and the readers recurse once for each part.
toml::table parse_values(std::string_view text, const std::string& file = "");

}  // namespace chladni::scene
