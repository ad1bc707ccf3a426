#include "cases/phases.hpp"

#include <algorithm>

namespace chladni::cases {

const report::PhaseTime& Phases::time_of(const std::string& name) const
{
  const auto named =
      std::ranges::find(times().rbegin(), times().rend(), name, &report::PhaseTime::name);
  return *named;
}

}  // namespace chladni::cases
