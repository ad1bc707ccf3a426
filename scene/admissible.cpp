#include "scene/admissible.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace chladni::scene {

bool admits(const Admissible& admissible, double x)
{
  return std::isfinite(x) && x > admissible.above && x >= admissible.at_least &&
         x < admissible.below && x <= admissible.at_most;
}

Admissible both(const Admissible& a, const Admissible& b)
{
  return {.above = std::max(a.above, b.above),
          .at_least = std::max(a.at_least, b.at_least),
          .below = std::min(a.below, b.below),
          .at_most = std::min(a.at_most, b.at_most),
          .unit = b.unit.empty() ? a.unit : b.unit,
          .usual_from = std::max(a.usual_from, b.usual_from),
          .usual_to = std::min(a.usual_to, b.usual_to),
          .usually = b.usually.empty() ? a.usually : b.usually};
}

std::string requirement(const Admissible& admissible, std::string_view kind)
{
  std::vector<std::string> bounds;
  const auto add_bound = [&](std::string_view relation, double bound) {
    if (std::isfinite(bound)) bounds.push_back(fmt::format("{} {}", relation, bound));
  };
  // Of two bounds on one side the weaker one says nothing.
  if (admissible.above >= admissible.at_least) add_bound(">", admissible.above);
  if (admissible.at_least > admissible.above) add_bound(">=", admissible.at_least);
  if (admissible.below <= admissible.at_most) add_bound("<", admissible.below);
  if (admissible.at_most < admissible.below) add_bound("<=", admissible.at_most);

  std::string text{kind};
  if (!bounds.empty())
    text += fmt::format("{}{}", text.empty() ? "" : " ", fmt::join(bounds, " and "));
  if (text.empty()) text = "finite";
  if (!admissible.unit.empty()) text += fmt::format(" ({})", admissible.unit);
  return text;
}

}  // namespace chladni::scene
