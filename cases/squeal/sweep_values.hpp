#pragma once

#include <string>
#include <vector>

#include "files/hdf5.hpp"

namespace chladni::cases {

/// Which keys of a scene take which values.
struct SweepValues {
  std::vector<std::string> keys;
  files::RowMajorMatrix values;  ///< [n_variants x n_keys], in the units of the scene
};

/// More variants than that are a slip of a count.
inline constexpr double variants_max = 1e6;

/// The grid of some keys, of which the last one varies fastest.
/// @param words  "KEY=FROM:TO:COUNT", equally spaced with both ends, or "KEY=VALUE,VALUE,..."
/// @throws chladni::Error with the word that is none of these, a key that comes twice, or the
/// number
///         of variants when it is above `variants_max`.
SweepValues sweep_grid(const std::vector<std::string>& words);

/// The variants of a file of comma-separated values: keys in its first line, then numbers.
/// @throws chladni::Error naming file, line and cell.
SweepValues read_samples(const std::string& file);

}  // namespace chladni::cases
