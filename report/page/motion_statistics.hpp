#pragma once

#include "report/json.hpp"
#include "squeal/results/signal_results.hpp"

namespace chladni::report {

/// What the page shows of the motion over the last rotations: figures, lines of its spectrum, and
/// the effective pad velocity over the angle of the disc.
Json statistics_page(const squeal::MotionStatistics& statistics);

}  // namespace chladni::report
