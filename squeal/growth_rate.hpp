#pragma once

#include <optional>

#include "squeal/results.hpp"

namespace chladni::squeal {

/// Slope of the least-squares line through ln(pad velocity) over the second half of the linear
/// phase, which ends when the pad displacement first exceeds `linear_limit` (m). The first half is
/// left to the modes that die out. Absent with less than eight points.
std::optional<double> growth_rate(const Envelope& envelope, double linear_limit);

}  // namespace chladni::squeal
