#include "scene/document.hpp"

#include <fmt/ranges.h>

#include "common/error.hpp"
#include "scene/document_node.hpp"
#include "scene/parse_values.hpp"

namespace chladni::scene {

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

}  // namespace chladni::scene
