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

// Free-interface methods cut clusters: which copies they take is arbitrary, and differs between
// numbers of ranks. A mass of 1e12 costs them digits.
// clang-format off
constexpr std::array<Known, 21> all{{
  {"BlockWithUnitRows", "MacNeal", "ranks sometimes", "1234"},
  {"ClusterOf50", "MacNeal", "ranks sometimes", "1234"},
  {"ClusterOf500", "MacNeal", "ranks sometimes", "1234"},
  {"ClusterOf50Spaced1e12", "MacNeal", "ranks sometimes", "1234"},
  {"CompactFreeSolid", "MacNeal", "ranks refused sometimes", "1234"},
  {"CompleteGraphAndIdentity", "MacNeal", "ranks sometimes", "1234"},
  {"Foil1in1000", "Rubin", "projection ranks sometimes", "1234"},
  {"Foil1in10000", "Eps", "not-converged sometimes", "1234"},
  {"Foil1in10000", "Rubin", "projection sometimes", "1234"},
  {"FreeBeam", "Rubin", "projection ranks sometimes", "1234"},
  {"FreeCableInSpace", "Rubin", "projection sometimes", "1234"},
  {"HypercubeAndIdentity", "MacNeal", "ranks sometimes", "1234"},
  {"Identity", "MacNeal", "ranks sometimes", "1234"},
  {"OneMassOf1e12", "MacNeal", "free-modes sometimes", "1234"},
  {"OneMassOf1e12", "Rubin", "free-modes projection sometimes", "1234"},
  {"ReflectedClusterOf50", "MacNeal", "ranks sometimes", "1234"},
  {"ReflectedClusterOf50", "Rubin", "ranks sometimes", "1234"},
  {"ReflectedClusterSpaced1e8", "MacNeal", "ranks sometimes", "1234"},
  {"ReflectedClusterSpaced1e8", "Rubin", "ranks sometimes", "1234"},
  {"SoftRootedBeamOnItsDeflections", "Rubin", "ranks sometimes", "1234"},
  {"StarOnALeaf", "MacNeal", "ranks sometimes", "1234"},
}};
// clang-format on

bool is_meant(const Known& known, const std::string& pencil, const std::string& way, int ranks)
{
  return known.pencil == pencil && known.way == way &&
         known.ranks.find(static_cast<char>('0' + ranks)) != std::string_view::npos;
}

}  // namespace

KnownWrong known_wrong(const std::string& pencil, const std::string& way, int ranks)
{
  const auto at = std::ranges::find_if(
      all, [&](const Known& known) { return is_meant(known, pencil, way, ranks); });
  if (at == all.end()) return {.properties = "", .sometimes = false};
  return {.properties = std::string(at->properties),
          .sometimes = at->properties.find("sometimes") != std::string_view::npos};
}

}  // namespace chladni::strangers
