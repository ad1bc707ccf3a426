#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace chladni::fuzz {

/// Damages a file of HDF5 as the bytes say, three for each damage: an object (by its place in the
/// order of names), what to do to it, and how. Datasets are removed, put in each other's place,
/// made anew with other extents (also with extents that overflow and no values behind them) or of
/// another type, or get values that no file should have; what is equally long in a group is cut
/// short together; root attributes change. The file stays one that the library can open, so that
/// what is tested are our own checks.
void damage(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace chladni::fuzz
