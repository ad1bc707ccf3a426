#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/signal_results.hpp"

namespace chladni::squeal {

/// Write and read the group /motion_statistics of a result file.
void write_statistics(files::Writer& file, const MotionStatistics& statistics);
MotionStatistics read_statistics(const files::Reader& file);

}  // namespace chladni::squeal
