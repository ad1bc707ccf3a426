#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "plate/assembly/alike_rows.hpp"
#include "plate/assembly/block_rows.hpp"
#include "plate/assembly/node_values.hpp"

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

/// Decides which values are entries: those above `negligible` times the scale sqrt |A_ii A_jj| of
/// their place. No entry of a positive semidefinite matrix is larger, and the errors of a Cholesky
/// factorisation are a few eps of it.
/// Source: Higham, Accuracy and Stability of Numerical Algorithms (2002), theorem 10.3.
struct Sieve {
  double negligible;
  const NodeValues* scales;  ///< sqrt |A_ii|; null: all but zeros are entries

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

/// Which values of each block are entries: what the sieve lets pass, and the diagonal. The others
/// become zero.
/// @return [n_blocks]
std::vector<BlockEntries> sifted(const HeldBlocks& blocks, const Sieve& sieve,
                                 std::vector<double>& values);

/// Turns the sums over a pattern into rows of scalars. The values stay in the memory of the sums,
/// since the rows of a node are never longer than its blocks.
/// @param entries  [n_blocks] of each block; where a partly stored one has no value, there is none
/// @throws chladni::Error when there are more entries than a PetscInt counts.
SplitRows split_rows(const HeldBlocks& blocks, std::vector<double> values,
                     const std::vector<BlockEntries>& entries);

}  // namespace chladni::plate
