#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "plate/assembly/block_rows.hpp"
#include "plate/assembly/entry_scales.hpp"

namespace chladni::plate {

/// Rows in CSR form: the entries in the columns of this rank, counted from its first, and in the
/// others.
struct SplitRows {
  std::vector<PetscInt> start{0};
  std::unique_ptr<PetscInt[]> column;
  std::vector<double> value;
  std::vector<PetscInt> other_start{0}, other_column;
  std::vector<double> other_value;
};

/// Sums over a pattern.
struct HeldBlocks {
  const BlockPattern& pattern;
  const std::vector<int>& held;               ///< n * i + j of blocks that do not hold all
  const std::vector<std::ptrdiff_t>& offset;  ///< [n_blocks + 1]
};

/// sqrt |A_ii| of the rows of this rank.
std::vector<double> diagonal_scales(const HeldBlocks& blocks, const std::vector<double>& values);

/// What counts as an entry: more than a part of the scale of its place.
struct Sieve {
  double negligible;
  const EntryScales* scales;  ///< null where only zeros are none

  /// [n] sqrt |A_ii| of the DOFs of a node, or zeros.
  const double* of(PetscInt node) const
  {
    static constexpr std::array<double, 6> zeros{};
    return scales ? scales->of(node) : zeros.data();
  }
  /// Symmetric to the last bit; what is no number counts.
  bool counts(double value, double row_scale, double column_scale) const
  {
    return !(std::abs(value) <= negligible * (row_scale * column_scale));
  }
};

/// Turns the sums over a pattern into rows of scalars: those off the diagonal that the sieve holds
/// back are left out. The values stay in the memory of the sums: the rows of a node never have more
/// than its blocks hold.
/// @throws chladni::Error when there are more entries than PETSc counts.
SplitRows split_rows(const HeldBlocks& blocks, std::vector<double> values, const Sieve& sieve);

}  // namespace chladni::plate
