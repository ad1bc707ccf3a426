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

std::string name_of_leader(std::int64_t node)
{
  return fmt::format("leader_{}", node);
}

const std::vector<std::int64_t>& nodes_of(const Deck& deck, const DeckCoupling& coupling)
{
  return std::ranges::find(deck.groups, coupling.group, &DeckGroup::name)->nodes;
}

[[noreturn]] void refuse(const DeckCoupling& coupling, const std::string& why)
{
  throw Error(fmt::format("{}: {}", coupling.entry, why));
}

/// The place of the reference node in the units of a scene.
std::array<double, 3> place_of(const Deck& deck, const DeckUnits& units,
                               const DeckCoupling& coupling)
{
  const auto node = deck.nodes.find(coupling.reference);
  if (node == deck.nodes.end())
    refuse(coupling, fmt::format("there is no node {}", coupling.reference));
  std::array<double, 3> x = node->second;
  for (double& c : x) c *= units.length;
  return x;
}

DeclaredCoupling average(const Deck& deck, const DeckUnits& units, const Holders& holders,
                         const DeckCoupling& coupling)
{
  const std::int64_t node = coupling.reference;
  if (holders.is_in_mesh(node)) {
    refuse(coupling, fmt::format("its reference node {} belongs to an element or follows another "
                                 "node; the mean of a scene moves a node of its own",
                                 node));
  }
  if (holders.is_reference(node))
    refuse(coupling, fmt::format("its reference node {} is that of another mean", node));
  for (const std::int64_t averaged : nodes_of(deck, coupling))
    if (!holders.is_in_mesh(averaged))
      refuse(coupling, fmt::format("its node {} belongs to no element", averaged));
  return {.name = name_of_reference(node),
          .group = coupling.group,
          .kind = CouplingOfDeck::averaging,
          .at = place_of(deck, units, coupling)};
}

DeclaredCoupling rigid(const Deck& deck, const DeckUnits& units, const Holders& holders,
                       const DeckCoupling& coupling)
{
  const std::int64_t node = coupling.reference;
  const std::array<double, 3> place = place_of(deck, units, coupling);
  if (holders.is_in_mesh(node) || holders.is_reference(node)) {
    return {.group = coupling.group,
            .kind = CouplingOfDeck::rigid,
            .to = holders.is_in_mesh(node) ? name_of_leader(node) : name_of_reference(node)};
  }
  return {.name = name_of_reference(node),
          .group = coupling.group,
          .kind = CouplingOfDeck::rigid,
          .at = place};
}

}  // namespace

Holders::Holders(const Deck& deck)
{
  for (const DeckElement& element : deck.elements)
    connected_.insert(element.nodes.begin(), element.nodes.end());
  for (const DeckCoupling& coupling : deck.couplings)
    if (!coupling.averages)
      followers_.insert(nodes_of(deck, coupling).begin(), nodes_of(deck, coupling).end());
}

std::vector<std::int64_t> supported_nodes(const Holders& holders, const std::string& entry,
                                          const std::vector<std::int64_t>& nodes, Declarations& all)
{
  std::vector<std::int64_t> supported, others;
  for (const std::int64_t node : nodes)
    (holders.is_in_mesh(node) || holders.is_reference(node) ? supported : others).push_back(node);
  if (!others.empty()) {
    all.notes.push_back(fmt::format(
        "{}: {} nodes that belong to no element and no coupling, as node {}, are passed "
        "over",
        entry, others.size(), others.front()));
  }
  return supported;
}

void add_leaders(Deck& deck)
{
  const Holders holders(deck);
  for (const DeckCoupling& coupling : deck.couplings) {
    if (coupling.averages || !holders.is_in_mesh(coupling.reference)) continue;
    const int group = group_index(deck, name_of_leader(coupling.reference), 0);
    deck.groups[std::size_t(group)].nodes = {coupling.reference};
  }
}

void declare_couplings(const Deck& deck, const DeckUnits& units, Holders& holders,
                       Declarations& all)
{
  // Rigid bodies may hang at the reference node of a mean.
  for (const bool averages : {true, false}) {
    for (const DeckCoupling& coupling : deck.couplings) {
      if (coupling.averages != averages) continue;
      all.couplings.push_back(averages ? average(deck, units, holders, coupling)
                                       : rigid(deck, units, holders, coupling));
      if (!all.couplings.back().name.empty()) holders.add_reference(coupling.reference);
      if (averages) {
        all.notes.push_back(
            fmt::format("{}: in the scene each of the nodes counts as the area that it stands for",
                        coupling.entry));
      }
    }
  }
}

std::set<std::string> Holders::of(const std::string& group,
                                  const std::vector<std::int64_t>& nodes) const
{
  std::set<std::string> names;
  for (const std::int64_t node : nodes) {
    const bool is_reference = references_.contains(node);
    if (!is_reference && !is_in_mesh(node))
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
