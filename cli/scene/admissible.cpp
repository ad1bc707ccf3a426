#include "cli/scene/admissible.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace chladni::cli {

bool admits(const Admissible& admissible, double x)
{
  return std::isfinite(x) && x > admissible.above && x >= admissible.at_least &&
         x < admissible.below && x <= admissible.at_most;
}

std::string requirement(const Admissible& admissible, std::string_view kind)
{
  std::vector<std::string> bounds;
  const auto add_bound = [&](std::string_view relation, double bound) {
    if (std::isfinite(bound)) bounds.push_back(fmt::format("{} {}", relation, bound));
  };
  add_bound(">", admissible.above);
  add_bound(">=", admissible.at_least);
  add_bound("<", admissible.below);
  add_bound("<=", admissible.at_most);

  std::string text{kind};
  if (!bounds.empty()) {
    text += fmt::format("{}{}", text.empty() ? "" : " ", fmt::join(bounds, " and "));
  }
  if (text.empty()) text = "finite";
  if (!admissible.unit.empty()) text += fmt::format(" ({})", admissible.unit);
  return text;
}

}  // namespace chladni::cli
