#pragma once

#include <string>
#include <vector>

#include "files/hdf5.hpp"

namespace chladni::cases {

/// The keys of a scene that vary, and their values in each variant.
struct SweepValues {
  std::vector<std::string> keys;
  files::RowMajorMatrix values;  ///< [n_variants x n_keys], in the units of the scene
};

/// The largest number of variants; more are taken for a mistake in a count.
inline constexpr double variants_max = 1e6;

/// The grid of some keys; the last one varies fastest.
/// @param words  "KEY=FROM:TO:COUNT", equally spaced with both ends, or "KEY=VALUE,VALUE,..."
/// @throws chladni::Error for a word of another form, a key that occurs twice, and for more than
///         `variants_max` variants.
SweepValues sweep_grid(const std::vector<std::string>& words);

/// The variants in a file of comma-separated values: keys in the first line, then numbers.
/// @throws chladni::Error naming file, line and cell.
SweepValues read_samples(const std::string& file);

}  // namespace chladni::cases
