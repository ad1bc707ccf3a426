#include "known.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace chladni::strangers {

namespace {

struct Known {
  std::string_view pencil, way, properties;
  std::string_view ranks;  ///< "1234"
};

// Between the sides of the foil lie 1e16; how far EPS comes depends on the order of elimination.
constexpr std::array<Known, 1> all{{
    {"Foil1in10000", "Eps", "not-converged", "23"},
}};

bool is_meant(const Known& known, const std::string& pencil, const std::string& way, int ranks)
{
  return known.pencil == pencil && known.way == way &&
         known.ranks.find(static_cast<char>('0' + ranks)) != std::string_view::npos;
}

}  // namespace

std::string known_wrong(const std::string& pencil, const std::string& way, int ranks)
{
  const auto at = std::ranges::find_if(
      all, [&](const Known& known) { return is_meant(known, pencil, way, ranks); });
  return at == all.end() ? "" : std::string(at->properties);
}

}  // namespace chladni::strangers
