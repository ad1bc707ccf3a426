#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "plate/assembly/block_rows.hpp"
#include "plate/assembly/entry_scales.hpp"

namespace chladni::plate {

/// Rows in CSR form, split into the entries in the columns of this rank, counted from its first
/// column, and the entries in other columns.
struct SplitRows {
  std::vector<PetscInt> start{0};
  std::unique_ptr<PetscInt[]> column;
  std::vector<double> value;
  std::vector<PetscInt> other_start{0}, other_column;
  std::vector<double> other_value;
};

/// Where the sums over a pattern are stored.
struct HeldBlocks {
  const BlockPattern& pattern;
  const std::vector<int>& held;  ///< n * i + j of the components that partly stored blocks have
  const std::vector<std::ptrdiff_t>& offset;  ///< [n_blocks + 1] start of each block
};

/// sqrt |A_ii| of the rows of this rank.
std::vector<double> diagonal_scales(const HeldBlocks& blocks, const std::vector<double>& values);

/// Decides which values are entries: those above `negligible` times the scale of their place.
struct Sieve {
  double negligible;
  const EntryScales* scales;  ///< null: all but zeros are entries

  /// [n] sqrt |A_ii| of the DOFs of a node; zeros without scales.
  const double* of(PetscInt node) const
  {
    static constexpr std::array<double, 6> zeros{};
    return scales ? scales->of(node) : zeros.data();
  }
  /// True if the value is an entry. The result is symmetric to the last bit; NaN is an entry.
  bool counts(double value, double row_scale, double column_scale) const
  {
    return !(std::abs(value) <= negligible * (row_scale * column_scale));
  }
};

/// Turns the sums over a pattern into rows of scalars and drops what the sieve holds back off the
/// diagonal. The values stay in the memory of the sums, since the rows of a node are never longer
/// than its blocks.
/// @throws chladni::Error when there are more entries than a PetscInt counts.
SplitRows split_rows(const HeldBlocks& blocks, std::vector<double> values, const Sieve& sieve);

}  // namespace chladni::plate
