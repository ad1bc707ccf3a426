#include "scene/document_node.hpp"

#include <fmt/ranges.h>

#include "common/error.hpp"

namespace chladni::scene {

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

}  // namespace chladni::scene
