#pragma once

#include <complex>
#include <cstddef>

namespace chladni::linear {

/// Entries that stand in columns or in rows, each `step` behind the one before.
template <typename Entry>
struct RawFactor {
  const Entry* values;
  std::ptrdiff_t step;
  bool stands_in_columns;
};

/// C is [m x n], and the sums have k terms.
struct ProductSize {
  std::ptrdiff_t m, n, k;
};

/// C <- C + factor A B with four numbers in an instruction, for processors that have AVX2 and FMA.
/// @param C  in columns, each `step` behind the one before
void add_product_by_avx2(const RawFactor<double>& A, const RawFactor<double>& B, double factor,
                         double* C, std::ptrdiff_t step, const ProductSize& size);
void add_product_by_avx2(const RawFactor<std::complex<double>>& A,
                         const RawFactor<std::complex<double>>& B, std::complex<double> factor,
                         std::complex<double>* C, std::ptrdiff_t step, const ProductSize& size);

}  // namespace chladni::linear
