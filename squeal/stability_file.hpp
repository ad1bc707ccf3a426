#pragma once

#include <optional>
#include <string>

#include "mbs_export/hdf5.hpp"
#include "squeal/stability_results.hpp"

namespace chladni::squeal {

/// Writes the datasets `stability`, `range/...` and `unstable/...` of a group; see
/// docs/file_formats.md.
/// @param unit  of the parameter
void write_profile(mbs_export::hdf5::Writer& file, const std::string& group,
                   const StabilityProfile& profile, const std::string& unit);

/// Reads them; absent when the group has none, as in files of earlier versions.
std::optional<StabilityProfile> read_profile(const mbs_export::hdf5::Reader& file,
                                             const std::string& group);

}  // namespace chladni::squeal
