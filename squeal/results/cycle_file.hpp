#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Write and read the group /limit_cycle_direct of a result file.
void write_direct(files::Writer& file, const DirectLimitCycle& cycle);
DirectLimitCycle read_direct(const files::Reader& file);

/// Write and read the group /limit_cycle_branch of a result file, with one dataset for each
/// quantity.
void write_branch(files::Writer& file, const LimitCycleBranch& branch);
LimitCycleBranch read_branch(const files::Reader& file);

}  // namespace chladni::squeal
