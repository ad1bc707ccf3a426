#include "cli/phases.hpp"

#include <algorithm>

namespace chladni::cli {

const PhaseTime& Phases::time_of(const std::string& name) const
{
  const auto named = std::ranges::find(times().rbegin(), times().rend(), name, &PhaseTime::name);
  return *named;
}

}  // namespace chladni::cli
