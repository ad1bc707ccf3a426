// Masses and springs at nodes.
#include <fmt/format.h>

#include <array>
#include <set>
#include <utility>

#include "common/error.hpp"
#include "mesh/decks/holders.hpp"
#include "mesh/decks/nastran.hpp"
#include "mesh/vectors.hpp"

namespace chladni::mesh {
namespace {

constexpr const char* component_names[] = {"x", "y", "z", "rx", "ry", "rz"};

/// Where an elastic scalar element stands: nodes and components, the second one 0 for the ground.
struct ScalarElement {
  std::array<std::int64_t, 2> nodes;
  std::array<std::int64_t, 2> components;  ///< 1 to 6
  std::array<int, 2> ends = {1, 2};        ///< of the card
};

class PointDeclarer {
 public:
  PointDeclarer(std::span<const Card> cards, const Deck& deck, const DeckUnits& units,
                const Holders& holders, Declarations& all)
      : deck_(deck), units_(units), holders_(holders), all_(all)
  {
    for (const Card& card : cards) {
      if (card.name() == "GRID" && card.integer_or(6, "CD", 0) != 0)
        in_own_axes_.insert(card.integer(1, "ID"));
      if (card.name() == "PELAS") add_properties(card);
    }
  }

  void mass(const Card& card)
  {
    card.expect_no_more_than(14);
    card.expect_blank(8, 8, "this field of CONM2 is blank");
    const std::int64_t node = card.integer(2, "G");
    const bool is_position = card.field(3) == "-1";
    if (!is_position && card.integer_or(3, "CID", 0) != 0)
      card.refuse("is in the system CID; only the basic one, 0 or -1, is known");
    Vector offset = card.vector_or_zero(5, "a component of X");
    if (is_position) offset = minus(offset, position(card, node));
    const auto moment = [&](std::size_t i) {
      return card.real_or(i, "a moment of inertia", 0.0) * units_.moment_of_inertia();
    };
    // I21, I31 and I32 are int x y dm; a scene's products of inertia have the other sign.
    all_.masses.push_back({.at = holder(card, name_of_mass(card), node),
                           .mass = card.real(4, "M") * units_.mass(),
                           .inertia = {moment(9), moment(11), moment(14), 0.0 - moment(10),
                                       0.0 - moment(12), 0.0 - moment(13)},
                           .offset = {offset[0] * units_.length, offset[1] * units_.length,
                                      offset[2] * units_.length}});
  }

  void spring_of_property(const Card& card)
  {
    card.expect_no_more_than(6);
    const std::int64_t property = card.integer_or(2, "PID", card.integer(1, "EID"));
    const auto found = stiffness_of_.find(property);
    if (found == stiffness_of_.end()) card.refuse(fmt::format("there is no PELAS {}", property));
    spring(card, found->second, scalar_element(card));
  }

  void spring_with_stiffness(const Card& card)
  {
    card.expect_no_more_than(8);
    refuse_damping(card, 7);
    spring(card, card.real(2, "K"), scalar_element(card));
  }

 private:
  static void refuse_damping(const Card& card, std::size_t i)
  {
    if (card.real_or(i, "GE", 0.0) != 0.0) {
      card.refuse(
          "GE: structural damping of springs is not read; take it out, and give loss_factor to the "
          "spring in the scene");
    }
  }

  /// One or two properties of four fields.
  void add_properties(const Card& card)
  {
    card.expect_no_more_than(8);
    for (const std::size_t i : {std::size_t{1}, std::size_t{5}}) {
      if (!card.has(i)) continue;
      refuse_damping(card, i + 2);
      if (!stiffness_of_.emplace(card.integer(i, "PID"), card.real(i + 1, "K")).second)
        card.refuse("its number is that of another PELAS");
    }
  }

  static ScalarElement scalar_element(const Card& card)
  {
    ScalarElement element{.nodes = {card.integer_or(3, "G1", 0), card.integer_or(5, "G2", 0)},
                          .components = {card.integer_or(4, "C1", 0), card.integer_or(6, "C2", 0)}};
    if (element.nodes[0] == 0) {  // the ground may stand first
      std::swap(element.nodes[0], element.nodes[1]);
      std::swap(element.components[0], element.components[1]);
      element.ends = {2, 1};
    }
    if (element.nodes[0] == 0) card.refuse("is at no node");
    return element;
  }

  void spring(const Card& card, double stiffness, const ScalarElement& element)
  {
    const auto& [nodes, components, ends] = element;
    if (stiffness < 0.0) card.refuse("its stiffness is negative");
    if (components[0] < 1 || components[0] > 6)
      card.refuse("is at no component from 1 to 6: a scene has no scalar points");
    const bool has_other = nodes[1] != 0;
    if (has_other && components[1] != components[0])
      card.refuse("joins two components; a spring of a scene acts in one direction");
    const auto c = static_cast<std::size_t>(components[0] - 1);
    DeclaredSpring spring{.at = holder(card, name_of_spring(card, ends[0]), nodes[0]),
                          .stiffness = {}};
    spring.stiffness[c] =
        stiffness * (c < 3 ? units_.force / units_.length : units_.force * units_.length);
    if (has_other) {
      spring.to = holder(card, name_of_spring(card, ends[1]), nodes[1]);
      tell_of_distance(card, nodes, c);
    }
    all_.springs.push_back(spring);
  }

  /// Between nodes apart, a scene's spring acts at the middle; a scalar element acts on each.
  void tell_of_distance(const Card& card, const std::array<std::int64_t, 2>& nodes,
                        std::size_t component)
  {
    Vector between = minus(position(card, nodes[1]), position(card, nodes[0]));
    if (component < 3) between[component] = 0.0;
    if (component > 2 || norm(between) == 0.0) return;
    all_.notes.push_back(fmt::format(
        "{} {}: its nodes are at a distance across {}; the spring of the scene acts midway between "
        "them, so that a rigid rotation causes no force",
        card.name(), card.field(1), component_names[component]));
  }

  Vector position(const Card& card, std::int64_t node) const
  {
    const auto found = deck_.nodes.find(node);
    if (found == deck_.nodes.end()) card.refuse(fmt::format("there is no node {}", node));
    return found->second;
  }

  /// The group of the node, or its name as a reference node of a coupling.
  std::string holder(const Card& card, const std::string& group, std::int64_t node) const
  {
    position(card, node);
    if (in_own_axes_.contains(node))
      card.refuse(fmt::format("node {} has a system CD; only the basic one is known here", node));
    try {
      return *holders_.of(group, {node}).begin();
    } catch (const Error& error) {
      card.refuse(error.what());
    }
  }

  const Deck& deck_;
  const DeckUnits& units_;
  const Holders& holders_;
  Declarations& all_;
  std::set<std::int64_t> in_own_axes_;
  std::map<std::int64_t, double> stiffness_of_;  ///< of each PELAS
};

}  // namespace

std::string name_of_mass(const Card& card)
{
  return fmt::format("conm2_{}", card.integer(1, "EID"));
}

std::string name_of_spring(const Card& card, int end)
{
  return fmt::format("celas_{}_{}", card.integer(1, "EID"), end);
}

std::array<std::int64_t, 2> nodes_of_spring(const Card& card)
{
  return {card.integer_or(3, "G1", 0), card.integer_or(5, "G2", 0)};
}

void declare_points(std::span<const Card> cards, const Deck& deck, const DeckUnits& units,
                    const Holders& holders, Declarations& all)
{
  PointDeclarer declarer(cards, deck, units, holders, all);
  for (const Card& card : cards) {
    if (card.name() == "CONM2") declarer.mass(card);
    if (card.name() == "CELAS1") declarer.spring_of_property(card);
    if (card.name() == "CELAS2") declarer.spring_with_stiffness(card);
  }
}

}  // namespace chladni::mesh
