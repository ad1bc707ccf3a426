#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

#include "common/error.hpp"
#include "mesh/decks/nastran.hpp"
#include "mesh/vectors.hpp"

namespace chladni::mesh {
namespace {

// Of DeckSystem::kind.
constexpr char rectangular = 'R', cylindrical = 'C', spherical = 'S';

bool is_system(const Card& card)
{
  return card.name() == "CORD2R" || card.name() == "CORD2C" || card.name() == "CORD2S";
}

/// Systems that are found one after the other, each after the one that it refers to.
class Finder {
 public:
  explicit Finder(std::span<const Card> cards)
  {
    found_[0] = {.origin = {}, .axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .kind = rectangular};
    for (const Card& card : cards) {
      if (!is_system(card)) continue;
      if (!cards_.emplace(card.integer(1, "CID"), &card).second) card.refuse("is there twice");
    }
  }

  DeckSystems all()
  {
    for (const auto& [number, card] : cards_) {
      if (number == 0) card->refuse("0 is the basic system");
      find(number, *card);
    }
    return found_;
  }

 private:
  void find(std::int64_t number, const Card& asking)
  {
    if (found_.contains(number)) return;
    const auto card = cards_.find(number);
    if (card == cards_.end())
      asking.refuse(fmt::format("there is no coordinate system {}", number));
    if (!under_way_.insert(number).second) card->second->refuse("refers to itself");
    const std::int64_t reference = card->second->integer_or(2, "RID", 0);
    find(reference, *card->second);
    found_[number] = made(*card->second, found_[reference]);
  }

  /// A, the origin; B on the z axis; C in the x-z plane.
  static DeckSystem made(const Card& card, const DeckSystem& reference)
  {
    card.expect_no_more_than(11);
    const auto point = [&](std::size_t first) {
      return basic_position(reference, card.vector_or_zero(first, "a point"));
    };
    const Vector A = point(3), z = minus(point(6), A), in_plane = minus(point(9), A);
    const Vector y = cross(z, in_plane);
    if (!(norm(y) > 1e-9 * norm(z) * norm(in_plane)))
      card.refuse("its three points are on one line");
    return {.origin = A, .axes = {unit(cross(y, z)), unit(y), unit(z)}, .kind = card.name().back()};
  }

  std::map<std::int64_t, const Card*> cards_;
  std::set<std::int64_t> under_way_;
  DeckSystems found_;
};

}  // namespace

DeckSystems nastran_systems(std::span<const Card> cards)
{
  return Finder(cards).all();
}

std::array<double, 3> basic_position(const DeckSystem& system, const std::array<double, 3>& x)
{
  Vector local = x;
  constexpr double degree = std::numbers::pi / 180.0;
  if (system.kind == cylindrical) {
    const double theta = x[1] * degree;
    local = {x[0] * std::cos(theta), x[0] * std::sin(theta), x[2]};
  }
  if (system.kind == spherical) {  // theta from the z axis, phi about it
    const double theta = x[1] * degree, phi = x[2] * degree, r = x[0] * std::sin(theta);
    local = {r * std::cos(phi), r * std::sin(phi), x[0] * std::cos(theta)};
  }
  Vector position = system.origin;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t c = 0; c < 3; ++c) position[c] += local[axis] * system.axes[axis][c];
  return position;
}

}  // namespace chladni::mesh
