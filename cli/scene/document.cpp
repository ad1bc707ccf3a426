#include "cli/scene/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/scene/document_node.hpp"
#include "common/error.hpp"

namespace chladni::cli {
namespace {

/// Says what is wrong with a value that should be a number of this kind; nothing when it is one.
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

double Table::number(std::string_view key, const Admissible& admissible) const
{
  return node_->value<double>(key, requirement(admissible, "a number"),
                              objection_to_number(admissible));
}

int Table::integer(std::string_view key, const Admissible& admissible) const
{
  return node_->value<int>(key, requirement(admissible, "a whole number"),
                           objection_to_integer(admissible));
}

std::string Table::text(std::string_view key) const
{
  return node_->value<std::string>(key, "a text in quotes", objection_to_text);
}

bool Table::truth(std::string_view key) const
{
  return node_->value<bool>(key, "true or false", objection_to_truth);
}

std::vector<double> Table::numbers(std::string_view key, const Admissible& admissible) const
{
  return node_->elements<double>(key, "a list of numbers", objection_to_number(admissible));
}

std::vector<int> Table::integers(std::string_view key, const Admissible& admissible) const
{
  return node_->elements<int>(key, "a list of whole numbers", objection_to_integer(admissible));
}

std::vector<std::string> Table::texts(std::string_view key) const
{
  return node_->elements<std::string>(key, "a list of texts in quotes", objection_to_text);
}

std::string_view Table::only_one_of(std::initializer_list<std::string_view> keys) const
{
  std::vector<std::string_view> present;
  for (const std::string_view key : keys) {
    if (has(key)) present.push_back(key);
  }
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
  return Table(node_->open(*value.as_table(), node_->path_of(key)));
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
    tables.push_back(Table(node_->open(*element.as_table(), element_path)));
  }
  return tables;
}

std::vector<std::string> Table::names() const
{
  std::vector<std::string> names;
  for (const auto& [key, value] : *node_->table) names.emplace_back(key.str());
  return names;
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
  for (const auto& [line, text] : node_->unknown_keys()) {
    message += (message.empty() ? "" : "\n") + text;
  }
  if (!message.empty()) throw Error(message);
}

Table parse_toml(const std::string& text, const std::string& file)
{
  try {
    const auto root = std::make_shared<const toml::table>(toml::parse(text, file));
    return Table(std::make_shared<Table::Node>(Table::Node{root, file, {}, root.get(), {}, {}}));
  } catch (const toml::parse_error& error) {
    throw Error(fmt::format("{}:{}: {}", file, error.source().begin.line, error.description()));
  }
}

}  // namespace chladni::cli
