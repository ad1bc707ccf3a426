#include "mesh/decks/nastran.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "common/error.hpp"
#include "mesh/decks/deck.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

using std::numbers::pi;

namespace {

std::string material_name(const Card& card, std::size_t i)
{
  return fmt::format("mat1_{}", card.integer(i, "MID"));
}

/// Whether two numbers are one to two digits, as G is often given.
bool agree_to_two_digits(double given, double exact)
{
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(given))) - 1.0);
  constexpr double half = 0.5 + 1e-9;
  return std::abs(given - exact) <= half * unit;
}

/// Two of E, G and nu, of which the third follows.
/// @param notes  gets what becomes of a G of few digits
DeclaredMaterial material(const Card& card, const DeckUnits& units, std::vector<std::string>& notes)
{
  card.expect_no_more_than(12);
  const bool has_young = card.has(2), has_shear = card.has(3), has_poisson = card.has(4);
  if (int(has_young) + int(has_shear) + int(has_poisson) < 2)
    card.refuse("needs two of E, G and NU");
  const double given = card.real_or(2, "E", 0.0), G = card.real_or(3, "G", 0.0);
  const double nu = has_poisson ? card.real(4, "NU") : given / (2.0 * G) - 1.0;
  const double young = has_young ? given : 2.0 * G * (1.0 + nu);
  constexpr double digits_of_a_field = 1e-3;
  const double isotropic = young / (2.0 * (1.0 + nu));
  if (has_young && has_shear && has_poisson &&
      std::abs(G - isotropic) > digits_of_a_field * isotropic) {
    if (!(G > 0.0 && agree_to_two_digits(G, isotropic))) {
      card.refuse(fmt::format(
          "G = {:.6g} is not E / (2 (1 + NU)) = {:.6g}; a scene's materials are isotropic", G,
          isotropic));
    }
    notes.push_back(
        fmt::format("MAT1 {}: G = {:.6g} has two digits; taken is E / (2 (1 + NU)) = "
                    "{:.6g}",
                    card.field(1), G, isotropic));
  }
  return {.name = material_name(card, 1),
          .young = young * units.stress(),
          .poisson = nu,
          .density = card.real_or(5, "RHO", 0.0) * units.density()};
}

/// WTMASS: by what masses and densities of the deck are multiplied.
double mass_factor(std::span<const Card> cards)
{
  const Card* said = nullptr;
  for (const Card& card : cards) {
    if (card.name() != "PARAM" || card.field(1) != "WTMASS") continue;
    if (!(card.real(2, "WTMASS") > 0.0)) card.refuse("must be a positive factor");
    if (said != nullptr && said->real(2, "WTMASS") != card.real(2, "WTMASS"))
      card.refuse(fmt::format("{} says another factor", said->place()));
    said = &card;
  }
  return said == nullptr ? 1.0 : said->real(2, "WTMASS");
}

void expect_no_mass(const Card& card, std::size_t i)
{
  if (card.real_or(i, "NSM", 0.0) != 0.0)
    card.refuse("mass that is not of the material (NSM) has no counterpart in a scene");
}

/// What cards say of properties and constraints, in SI units.
class NastranDeclarer {
 public:
  NastranDeclarer(std::span<const Card> cards, const Deck& deck, const DeckUnits& units)
      : cards_(cards), deck_(deck), units_(units), holders_(deck)
  {}

  Declarations declare()
  {
    for (const Card& card : cards_) {
      if (card.name() == "PSOLID") solid(card);
      if (card.name() == "PSHELL") shell(card);
      if (card.name() == "PBAR") bar(card);
      if (card.name() == "PBARL") bar_by_shape(card);
      if (card.name() == "PBEAM") beam(card);
    }
    materials();
    declare_couplings(deck_, units_, holders_, all_);
    for (const RigidElement& element : rigid_elements(cards_, deck_)) {
      if (!element.is_of_displacements()) continue;
      all_.notes.push_back(fmt::format(
          "{} {}: REFC is 123; in the scene the rotations of node {} follow the mean too",
          element.card->place(), element.card->name(), element.reference));
    }
    supports();
    declare_points(cards_, deck_, units_, holders_, all_);
    for (std::size_t g = 0; g < deck_.groups.size(); ++g) check_has_section(g);
    return std::move(all_);
  }

 private:
  void check_has_section(std::size_t g) const
  {
    const DeckGroup& group = deck_.groups[g];
    if (group.dimension == 0 || all_.has_section(group.name)) return;
    const auto element = std::ranges::find(deck_.elements, int(g), &DeckElement::group);
    throw Error(fmt::format("{}: element {} is of {}, and there is no such property",
                            element->place, element->number, group.name));
  }

  bool is_used(const std::string& group) const
  {
    return std::ranges::find(deck_.groups, group, &DeckGroup::name) != deck_.groups.end();
  }

  /// Of materials of no element, those without a density are left out.
  void materials()
  {
    for (const Card& card : cards_) {
      if (card.name() != "MAT1") continue;
      DeclaredMaterial found = material(card, units_, all_.notes);
      found.density *= mass_factor(cards_);
      if (found.density > 0.0 || all_.uses(found.name)) all_.add(found, card.place());
    }
  }

  /// PID MID CORDM IN STRESS ISOP FCTN; the material is isotropic, so that its axes do not matter.
  void solid(const Card& card)
  {
    const std::string group = fmt::format("psolid_{}", card.integer(1, "PID"));
    card.expect_no_more_than(7);
    if (!is_used(group)) return;
    if (card.has(7) && card.field(7) != "SMECH") {
      card.refuse(
          fmt::format("FCTN = {} is no structure; take it out, or model it apart", card.field(7)));
    }
    const bool is_reduced = card.field(6) == "REDUCED" || card.field(6) == "0";
    if (is_reduced) {
      all_.notes.push_back(
          fmt::format("PSOLID {}: its elements are of full integration here", card.field(1)));
    }
    all_.solids.push_back({.group = group, .material = material_name(card, 2)});
  }

  void shell(const Card& card)
  {
    const std::string group = fmt::format("pshell_{}", card.integer(1, "PID"));
    card.expect_no_more_than(10);
    if (!is_used(group)) return;
    if (!card.has(4)) card.refuse("has no MID2: a membrane without bending is no shell here");
    if (card.integer(4, "MID2") != card.integer(2, "MID1"))
      card.refuse("MID1 and MID2 differ; a scene's section has one material");
    constexpr double written = 1e-4;  // 5/6 stands there as 0.8333 too
    if (std::abs(card.real_or(5, "12I/T**3", 1.0) - 1.0) > written)
      card.refuse("12I/T**3 is not 1; a scene's shells bend as their thickness says");
    if (card.has(6) && card.integer(6, "MID3") != card.integer(2, "MID1"))
      card.refuse("MID1 and MID3 differ; a scene's section has one material");
    if (std::abs(card.real_or(7, "TS/T", 5.0 / 6.0) - 5.0 / 6.0) > written)
      card.refuse("TS/T is not 5/6, the shear factor of a scene's shells");
    expect_no_mass(card, 8);
    if (!card.has(6)) {
      all_.notes.push_back(
          fmt::format("PSHELL {} has no MID3, and is rigid in transverse shear there; {} is not",
                      card.field(1), group));
    }
    all_.shells.push_back({.group = group,
                           .material = material_name(card, 2),
                           .thickness = card.real(3, "T") * units_.length,
                           .offset = 0.0});
  }

  /// For each group of the property, which has one vector.
  void add_beam(const Card& card, const std::string& property, const DeclaredBeam& beam)
  {
    for (const DeckGroup& group : deck_.groups)
      if (group.name == property || group.name.starts_with(property + "_"))
        add_beam_of_group(card, group.name, beam);
  }

  /// The scene's z is Nastran's y, along its vector.
  void add_beam_of_group(const Card& card, const std::string& group, DeclaredBeam beam)
  {
    beam.group = group;
    beam.material = material_name(card, 2);
    beam.area *= units_.area();
    for (double* second : {&beam.I_y, &beam.I_z, &beam.J}) *second *= units_.second_moment();
    const bool is_alike = beam.I_y == beam.I_z && beam.shear_factor_y == beam.shear_factor_z;
    if (!is_alike) beam.orientation = orientation_of(group);
    all_.beams.push_back(beam);
  }

  void bar(const Card& card)
  {
    const std::string group = fmt::format("pbar_{}", card.integer(1, "PID"));
    card.expect_no_more_than(19);
    if (!is_used(group)) return;
    expect_no_mass(card, 7);
    if (card.real_or(19, "I12", 0.0) != 0.0)
      card.refuse("I12: the axes must be the principal ones");
    add_beam(card, group,
             with_shear(card,
                        {.area = card.real(3, "A"),
                         .I_y = card.real(4, "I1"),
                         .I_z = card.real(5, "I2"),
                         .J = card.real_or(6, "J", 0.0)},
                        0.0));
  }

  void bar_by_shape(const Card& card)
  {
    const std::string group = fmt::format("pbar_{}", card.integer(1, "PID"));
    if (is_used(group)) add_beam(card, group, bar_of_shape(card));
  }

  /// K1 belongs to the plane of the vector, which is x-z in a scene. 0 is infinite stiffness in
  /// shear, as in Nastran.
  /// @param usual  K1 and K2 where they are blank
  static DeclaredBeam with_shear(const Card& card, DeclaredBeam beam, double usual)
  {
    const double K_1 = card.real_or(17, "K1", usual), K_2 = card.real_or(18, "K2", usual);
    if ((K_1 == 0.0) != (K_2 == 0.0)) {
      card.refuse(
          "is rigid in shear (K = 0) in one of its two planes; a scene's beam is so in both or in "
          "none");
    }
    if (K_1 == 0.0) return beam;
    beam.shear_factor_z = K_1;
    beam.shear_factor_y = K_2;
    return beam;
  }

  void beam(const Card& card)
  {
    const std::string group = fmt::format("pbeam_{}", card.integer(1, "PID"));
    if (!is_used(group)) return;
    for (const std::size_t i : {9, 17})
      if (card.field(i) == "YES" || card.field(i) == "YESA" || card.field(i) == "NO")
        card.refuse("has more than one station; a scene's beams are the same from end to end");
    for (std::size_t i = 19; i <= card.n_fields(); ++i)
      if (card.has(i) && card.real(i, "a number") != 0.0)
        card.refuse(fmt::format("field {} has no counterpart in a scene", i + 1));
    if (card.real_or(6, "I12", 0.0) != 0.0) card.refuse("I12: the axes must be the principal ones");
    expect_no_mass(card, 8);
    add_beam(card, group,
             with_shear(card,
                        {.area = card.real(3, "A"),
                         .I_y = card.real(4, "I1"),
                         .I_z = card.real(5, "I2"),
                         .J = card.real_or(7, "J", 0.0)},
                        1.0));
  }

  /// The vector that all beams of a group share.
  Vector orientation_of(const std::string& group) const
  {
    const auto g = std::ranges::find(deck_.groups, group, &DeckGroup::name) - deck_.groups.begin();
    const auto element = std::ranges::find(deck_.elements, int(g), &DeckElement::group);
    for (const Card& card : cards_)
      if ((card.name() == "CBAR" || card.name() == "CBEAM") && card.place() == element->place)
        return vector_of_beam(card, deck_);
    return {0.0, 0.0, 1.0};
  }

  /// What `make` returns; its errors get the card.
  static auto told(const Card& card, auto&& make)
  {
    try {
      return make();
    } catch (const Error& error) {
      card.refuse(error.what());
    }
  }

  void support(const Card& card, const std::string& group, const HeldNodes& held)
  {
    const auto in_basic_axes =
        told(card, [&] { return holders_.held_in_basic_axes(deck_, held.nodes, held.components); });
    if (in_basic_axes.size() < held.nodes.size()) {
      all_.notes.push_back(fmt::format(
          "{} {}: components in the system CD of nodes are held as equations, which the "
          "mesh has and the scene does not show",
          card.place(), card.name()));
      if (in_basic_axes.empty()) return;
    }
    const std::string entry = fmt::format("{}: {} {}", card.place(), card.name(), card.field(1));
    const auto nodes = supported_nodes(holders_, entry, in_basic_axes, all_);
    for (const std::string& holder : told(card, [&] { return holders_.of(group, nodes); }))
      add_support(all_, holder, held.components);
  }

  /// A node that no element has, and that nothing follows, is held for nobody: GRDSET holds all.
  void support_of_grid(const Card& card, const HeldNodes& held)
  {
    const std::int64_t node = held.nodes.front();
    if (holders_.is_in_mesh(node) || holders_.is_reference(node))
      support(card, name_of_held_by_grid(held.components), held);
  }

  void supports()
  {
    const ChosenSets chosen = chosen_sets(cards_, "SPC");
    for (const ChosenSets& of_kind : {chosen, chosen_sets(cards_, "MPC")})
      std::ranges::copy(of_kind.notes, std::back_inserter(all_.notes));
    for (const Card& card : cards_) {
      if (card.name() == "GRID" && !held_by_grid(card).empty()) {
        const HeldNodes held{
            .set = 0, .components = held_by_grid(card), .nodes = {card.integer(1, "ID")}};
        support_of_grid(card, held);
      }
      if (card.name() != "SPC" && card.name() != "SPC1") continue;
      const auto moves = [&](std::size_t i) { return card.real_or(i, "D", 0.0) != 0.0; };
      if (card.name() == "SPC" && (moves(4) || moves(7))) {
        all_.notes.push_back(fmt::format(
            "{}: SPC {} prescribes a displacement; small vibrations have it held at zero",
            card.place(), card.field(1)));
      }
      for (const HeldNodes& held : held_nodes(card, deck_))
        if (chosen.sets.contains(held.set))
          support(card, name_of_held(held.set, held.components), held);
    }
  }

  std::span<const Card> cards_;
  const Deck& deck_;
  DeckUnits units_;
  Holders holders_;
  Declarations all_;
};

}  // namespace

Declarations nastran_declarations(std::span<const Card> cards, const Deck& deck,
                                  const DeckUnits& units)
{
  return NastranDeclarer(cards, deck, units).declare();
}

// Masses and springs at nodes.

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
      : deck_(deck), units_(units), holders_(holders), all_(all), known_(deck)
  {
    for (const Card& card : cards) {
      if (card.name() == "GRID" && card.integer_or(6, "CD", 0) != 0)
        in_own_axes_.insert(card.integer(1, "ID"));
      if (card.name() == "PELAS") add_properties(card);
      if (card.name() == "PBUSH") bush_of_.emplace(card.integer(1, "PID"), &card);
    }
    mass_factor_ = mass_factor(cards);
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
      return mass_factor_ * card.real_or(i, "a moment of inertia", 0.0) *
             units_.moment_of_inertia();
    };
    // I21, I31 and I32 are int x y dm; a scene's products of inertia have the other sign.
    all_.masses.push_back({.at = holder(card, name_of_mass(card), node),
                           .mass = mass_factor_ * card.real(4, "M") * units_.mass(),
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

  /// Springs for elongation and torsion, a mass of half of the rod at each end. A CROD has a PROD:
  /// PID MID A J C NSM; of a CONROD these stand behind its nodes.
  void rod(const Card& card, std::span<const Card> cards)
  {
    const Card* property = &card;
    if (card.name() == "CROD") {
      const std::int64_t number = card.integer_or(2, "PID", card.integer(1, "EID"));
      const auto is_it = [&](const Card& other) {
        return other.name() == "PROD" && other.integer(1, "PID") == number;
      };
      const auto found = std::ranges::find_if(cards, is_it);
      if (found == cards.end()) card.refuse(fmt::format("there is no PROD {}", number));
      property = &*found;
    }
    const std::size_t first = card.name() == "CROD" ? 2 : 4;  // of MID
    const std::int64_t mid = property->integer(first, "MID");
    const auto of_it = std::ranges::find_if(cards, [&](const Card& other) {
      return other.name() == "MAT1" && other.integer(1, "MID") == mid;
    });
    if (of_it == cards.end()) property->refuse(fmt::format("there is no MAT1 {}", mid));
    std::vector<std::string> told_elsewhere;
    const DeclaredMaterial stuff = material(*of_it, units_, told_elsewhere);
    const auto [a, b] = nodes_of_rod(card);
    const double length = norm(minus(position(card, b), position(card, a))) * units_.length;
    const double area = property->real_or(first + 1, "A", 0.0) * units_.area(),
                 J = property->real_or(first + 2, "J", 0.0) * units_.second_moment(),
                 shear = stuff.young / (2.0 + 2.0 * stuff.poisson);
    DeclaredSpring spring{.at = name_of_rod(card, 0), .stiffness = {stuff.young * area / length}};
    if (J > 0.0 && known_.turns(a) && known_.turns(b))
      spring.stiffness[3] = shear * J / length;
    else if (J > 0.0)
      all_.notes.push_back(
          fmt::format("{} {}: a node of solids does not turn, so that its torsion is left out",
                      card.place(), card.name()));
    all_.springs.push_back(spring);
    const double of_length =
        property->real_or(first + 4, "NSM", 0.0) * units_.mass() / units_.length;
    const double mass = mass_factor_ * (stuff.density * area + of_length) * length;
    for (const int end : {1, 2})
      if (mass > 0.0) {
        all_.masses.push_back({.at = holder(card, name_of_rod(card, end), end == 1 ? a : b),
                               .mass = 0.5 * mass,
                               .inertia = {},
                               .offset = {}});
      }
  }

  /// EID PID GA GB, a vector or G0, CID: six springs in axes that must be coordinate axes unless
  /// all displacements, and all rotations, are alike.
  void bush(const Card& card)
  {
    card.expect_blank(9, std::max<std::size_t>(9, card.n_fields()),
                      "its place is not in the middle between its nodes");
    const std::int64_t property = card.integer_or(2, "PID", card.integer(1, "EID"));
    const auto found = bush_of_.find(property);
    if (found == bush_of_.end()) card.refuse(fmt::format("there is no PBUSH {}", property));
    const std::array<double, 6> k = stiffness_of_bush(*found->second);
    const std::int64_t a = card.integer(3, "GA"), b = card.integer_or(4, "GB", 0);
    std::array<std::size_t, 3> global{0, 1, 2};
    const bool is_round = k[0] == k[1] && k[1] == k[2] && k[3] == k[4] && k[4] == k[5];
    if (!is_round && !(card.has(8) && card.integer(8, "CID") == 0)) {
      if (card.has(8)) card.refuse("is in the system CID; only the basic one, 0, is known");
      global = axes_of_bush(card, k);
    }
    DeclaredSpring spring{.at = holder(card, name_of_spring(card, 1), a), .stiffness = {}};
    if (b != 0) spring.to = holder(card, name_of_spring(card, 2), b);
    for (std::size_t i = 0; i < 3; ++i) {
      spring.stiffness[global[i]] = k[i] * units_.force / units_.length;
      spring.stiffness[3 + global[i]] = k[3 + i] * units_.force * units_.length;
    }
    all_.springs.push_back(spring);
  }

 private:
  /// The K of a PBUSH; its damping and stress factors are left out.
  std::array<double, 6> stiffness_of_bush(const Card& card)
  {
    std::array<double, 6> k{};
    for (std::size_t i = 2; i <= card.n_fields(); i += 8) {
      const std::string_view word = card.field(i);
      if (word == "K") {
        for (std::size_t c = 0; c < 6; ++c) k[c] = card.real_or(i + 1 + c, "a stiffness", 0.0);
      } else if (word == "B" || word == "GE") {
        all_.notes.push_back(fmt::format("{}: PBUSH {}: its damping {} is left out", card.place(),
                                         card.field(1), word));
      } else if (!word.empty() && word != "RCV") {
        card.refuse(fmt::format("\"{}\" is not known; K, B, GE and RCV are", word));
      }
    }
    return k;
  }

  /// The coordinate axes along the axes of a bush: x from GA to GB, y towards the vector.
  std::array<std::size_t, 3> axes_of_bush(const Card& card, const std::array<double, 6>& k) const
  {
    constexpr double straight = 1e-6;
    const auto nearest = [&](const Vector& v) -> std::size_t {
      for (std::size_t c = 0; c < 3; ++c)
        if (std::abs(v[c]) >= (1.0 - straight) * norm(v)) return c;
      card.refuse("its axes are no coordinate axes, along which springs of a scene act");
    };
    const std::int64_t a = card.integer(3, "GA"), b = card.integer_or(4, "GB", 0);
    const Vector along = b == 0 ? Vector{} : minus(position(card, b), position(card, a));
    if (!(norm(along) > 0.0))
      card.refuse("joins nodes at one place, or one to the ground, and has no CID");
    const std::size_t x = nearest(along);
    if (k[1] == k[2] && k[4] == k[5]) return {x, (x + 1) % 3, (x + 2) % 3};
    const bool is_node = card.has(5) && !card.has(6) && !card.has(7) &&
                         card.field(5).find('.') == std::string_view::npos;
    const Vector v = is_node ? minus(position(card, card.integer(5, "G0")), position(card, a))
                             : card.vector_or_zero(5, "a component");
    const Vector z = cross(along, v);
    if (!(norm(z) > 0.0)) card.refuse("has no vector to orient it");
    const std::size_t of_z = nearest(z);
    return {x, 3 - x - of_z, of_z};
  }

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
  NodesOfDeck known_;
  std::set<std::int64_t> in_own_axes_;
  std::map<std::int64_t, double> stiffness_of_;  ///< of each PELAS
  std::map<std::int64_t, const Card*> bush_of_;  ///< PBUSH by number
  double mass_factor_ = 1.0;
};

}  // namespace

Vector vector_of_beam(const Card& card, const Deck& deck)
{
  const std::int64_t end = card.integer(3, "GA");
  Vector v = card.vector_or_zero(5, "a component");
  const bool is_node = !card.has(6) && !card.has(7) && card.has(5) &&
                       card.field(5).find('.') == std::string_view::npos;
  const auto axes = deck.axes.find(end);
  if (is_node) {
    const auto to = deck.nodes.find(card.integer(5, "G0")), from = deck.nodes.find(end);
    if (to == deck.nodes.end() || from == deck.nodes.end()) card.refuse("its G0 is not there");
    v = minus(to->second, from->second);
  } else if (axes != deck.axes.end()) {
    Vector sum{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += v[i] * axes->second[i][c];
    v = sum;
  }
  if (!(norm(v) > 0.0)) card.refuse("has no vector to orient it");
  return unit(v);
}

std::string name_of_mass(const Card& card)
{
  return fmt::format("conm2_{}", card.integer(1, "EID"));
}

std::string name_of_spring(const Card& card, int end)
{
  const char* kind = card.name() == "CBUSH" ? "cbush" : "celas";
  return fmt::format("{}_{}_{}", kind, card.integer(1, "EID"), end);
}

std::array<std::int64_t, 2> nodes_of_spring(const Card& card)
{
  return {card.integer_or(3, "G1", 0), card.integer_or(card.name() == "CBUSH" ? 4 : 5, "G2", 0)};
}

bool is_rod(const Card& card)
{
  return card.name() == "CROD" || card.name() == "CONROD";
}

std::array<std::int64_t, 2> nodes_of_rod(const Card& card)
{
  const std::size_t first = card.name() == "CROD" ? 3 : 2;
  return {card.integer(first, "G1"), card.integer(first + 1, "G2")};
}

std::string name_of_rod(const Card& card, int end)
{
  const std::string name = fmt::format("rod_{}", card.integer(1, "EID"));
  return end == 0 ? name : fmt::format("{}_{}", name, end);
}

void declare_points(std::span<const Card> cards, const Deck& deck, const DeckUnits& units,
                    const Holders& holders, Declarations& all)
{
  PointDeclarer declarer(cards, deck, units, holders, all);
  for (const Card& card : cards) {
    if (card.name() == "CONM2") declarer.mass(card);
    if (card.name() == "CELAS1") declarer.spring_of_property(card);
    if (card.name() == "CELAS2") declarer.spring_with_stiffness(card);
    if (card.name() == "CBUSH") declarer.bush(card);
    if (is_rod(card)) declarer.rod(card, cards);
  }
}

// Sections of bars by their shapes.

namespace {

/// A dimension that must be a length.
double dimension(const Card& card, std::size_t i)
{
  const double value = card.real(8 + i, fmt::format("DIM{}", i));
  if (!(value > 0.0)) card.refuse(fmt::format("DIM{} is no length", i));
  return value;
}

DeclaredBeam circle(double outer, double inner, double shear_factor)
{
  const double I = 0.25 * pi * (std::pow(outer, 4) - std::pow(inner, 4));
  return {.area = pi * (outer * outer - inner * inner),
          .I_y = I,
          .I_z = I,
          .J = 2.0 * I,
          .shear_factor_y = shear_factor,
          .shear_factor_z = shear_factor};
}

/// @param width   along the element's z axis
/// @param height  along its y axis, which is a scene's z
/// Source of J: Young and Budynas, Roark's Formulas for Stress and Strain, 7th ed., table 10.1.
DeclaredBeam rectangular_beam(double width, double height)
{
  const double a = 0.5 * std::max(width, height), b = 0.5 * std::min(width, height);
  const double slimness = b / a;
  const double J =
      a * std::pow(b, 3) * (16.0 / 3.0 - 3.36 * slimness * (1.0 - std::pow(slimness, 4) / 12.0));
  return {.area = width * height,
          .I_y = width * std::pow(height, 3) / 12.0,
          .I_z = height * std::pow(width, 3) / 12.0,
          .J = J,
          .shear_factor_y = 5.0 / 6.0,
          .shear_factor_z = 5.0 / 6.0};
}

}  // namespace

DeclaredBeam bar_of_shape(const Card& card)
{
  card.expect_blank(5, 8, "this field of PBARL is blank");
  const std::string shape(card.field(4));
  const std::size_t n = shape == "ROD" ? 1 : 2;
  if (shape != "ROD" && shape != "TUBE" && shape != "BAR") {
    card.refuse(
        fmt::format("the shape \"{}\" is not known; there are ROD, TUBE and BAR, for others "
                    "take PBAR",
                    shape));
  }
  if (card.real_or(9 + n, "NSM", 0.0) != 0.0)
    card.refuse("mass that is not of the material (NSM) has no counterpart in a scene");
  card.expect_no_more_than(9 + n);
  if (shape == "ROD") return circle(dimension(card, 1), 0.0, 0.9);
  if (shape == "BAR") return rectangular_beam(dimension(card, 1), dimension(card, 2));
  const double inner = card.real(10, "DIM2"), outer = dimension(card, 1);
  if (!(inner >= 0.0 && inner < outer)) card.refuse("DIM2, the inner radius, is not below DIM1");
  return circle(outer, inner, 0.5);
}

}  // namespace chladni::mesh
