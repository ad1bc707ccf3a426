#pragma once

#include "report/json.hpp"
#include "squeal/results/signal_results.hpp"

namespace chladni::report {

/// The statistics of a motion over the last rotations for the page: figures, spectral lines, and
/// the effective pad velocity over the disc's angle.
Json statistics_page(const squeal::MotionStatistics& statistics);

}  // namespace chladni::report
