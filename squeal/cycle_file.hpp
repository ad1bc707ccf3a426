#pragma once

#include "mbs_export/hdf5.hpp"
#include "squeal/results.hpp"

namespace chladni::squeal {

/// The group /limit_cycle_direct of a result file.
void write_direct(mbs_export::hdf5::Writer& file, const DirectLimitCycle& cycle);
DirectLimitCycle read_direct(const mbs_export::hdf5::Reader& file);

/// The group /limit_cycle_branch of a result file: one dataset for each quantity.
void write_branch(mbs_export::hdf5::Writer& file, const LimitCycleBranch& branch);
LimitCycleBranch read_branch(const mbs_export::hdf5::Reader& file);

}  // namespace chladni::squeal
