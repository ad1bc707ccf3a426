#include "mesh/decks/holders.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::mesh {
namespace {

std::string name_of_reference(std::int64_t node)
{
  return fmt::format("node_{}", node);
}

}  // namespace

Holders::Holders(const Deck& deck)
{
  for (const DeckElement& element : deck.elements)
    connected_.insert(element.nodes.begin(), element.nodes.end());
}

std::string Holders::add_reference(std::int64_t node)
{
  if (connected_.contains(node)) {
    throw Error(fmt::format(
        "its reference node {} belongs to an element; in a scene it must belong to none", node));
  }
  if (!references_.insert(node).second)
    throw Error(fmt::format("its reference node {} is that of another coupling", node));
  return name_of_reference(node);
}

std::set<std::string> Holders::of(const std::string& group,
                                  const std::vector<std::int64_t>& nodes) const
{
  std::set<std::string> names;
  for (const std::int64_t node : nodes) {
    const bool is_reference = references_.contains(node);
    if (!is_reference && !connected_.contains(node))
      throw Error(fmt::format("its node {} belongs to no element and no coupling", node));
    names.insert(is_reference ? name_of_reference(node) : group);
  }
  return names;
}

void add_support(Declarations& all, const std::string& group, const std::vector<int>& components)
{
  const auto is_same = [&](const DeclaredSupport& other) {
    return other.group == group && other.components == components;
  };
  if (std::ranges::none_of(all.supports, is_same))
    all.supports.push_back({.group = group, .components = components});
}

}  // namespace chladni::mesh
