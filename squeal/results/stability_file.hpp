#pragma once

#include <optional>
#include <string>

#include "files/hdf5.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// Writes the datasets `stability`, `range/...` and `unstable/...` of a group; see
/// docs/file_formats.md.
/// @param unit  of the parameter
void write_profile(files::Writer& file, const std::string& group, const StabilityProfile& profile,
                   const std::string& unit);

/// Reads them; absent when the group has none, as in files of earlier versions.
std::optional<StabilityProfile> read_profile(const files::Reader& file, const std::string& group);

}  // namespace chladni::squeal
