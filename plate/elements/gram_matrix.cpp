#ifdef __x86_64__
#include <immintrin.h>
#endif

#include <array>

#include "plate/elements/strain_energy.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;

constexpr Index n_a = 4, n_b = 8;  // a tile of K that fits into the vector registers

// K = R^T R on and above the diagonal, R [n_rows x n] and K [n x n] by rows, n a multiple of 8.

void upper_gram(const double* __restrict R, Index n_rows, Index n, double* __restrict K)
{
  for (Index i = 0; i < n; i += n_a) {
    for (Index j = i / n_b * n_b; j < n; j += n_b) {
      std::array<std::array<double, n_b>, n_a> sum{};
      for (Index k = 0; k < n_rows; ++k) {
        const double* row = R + k * n;
        for (Index a = 0; a < n_a; ++a)
          for (Index b = 0; b < n_b; ++b) sum[a][b] += row[i + a] * row[j + b];
      }
      for (Index a = 0; a < n_a; ++a)
        for (Index b = 0; b < n_b; ++b) K[(i + a) * n + j + b] = sum[a][b];
    }
  }
}

#ifdef __x86_64__
/// The same with vectors of four and fused products: twice as fast as what the compiler makes of
/// the loops above for the same processor.
[[gnu::target("avx2,fma")]] void upper_gram_avx2(const double* __restrict R, Index n_rows, Index n,
                                                 double* __restrict K)
{
  for (Index i = 0; i < n; i += n_a) {
    for (Index j = i / n_b * n_b; j < n; j += n_b) {
      __m256d left[n_a] = {}, right[n_a] = {};  // NOLINT(modernize-avoid-c-arrays): registers
      for (Index k = 0; k < n_rows; ++k) {
        const double* row = R + k * n;
        const __m256d row_left = _mm256_loadu_pd(row + j);
        const __m256d row_right = _mm256_loadu_pd(row + j + 4);
        for (Index a = 0; a < n_a; ++a) {
          const __m256d factor = _mm256_broadcast_sd(row + i + a);
          left[a] = _mm256_fmadd_pd(factor, row_left, left[a]);
          right[a] = _mm256_fmadd_pd(factor, row_right, right[a]);
        }
      }
      for (Index a = 0; a < n_a; ++a) {
        _mm256_storeu_pd(K + (i + a) * n + j, left[a]);
        _mm256_storeu_pd(K + (i + a) * n + j + 4, right[a]);
      }
    }
  }
}
#endif

using UpperGram = void (*)(const double* __restrict, Index, Index, double* __restrict);

UpperGram best_upper_gram()
{
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return upper_gram_avx2;
#endif
  return upper_gram;
}

}  // namespace

Eigen::MatrixXd gram_matrix(const StrainRows& R)
{
  const Index n = R.cols();
  const Index padded = (n + n_b - 1) / n_b * n_b;
  StrainRows wide;
  if (padded != n) {
    wide.setZero(R.rows(), padded);
    wide.leftCols(n) = R;
  }
  StrainRows upper(padded, padded);
  static const UpperGram upper_gram_here = best_upper_gram();
  upper_gram_here(padded == n ? R.data() : wide.data(), R.rows(), padded, upper.data());
  Eigen::MatrixXd K(n, n);
  K.triangularView<Eigen::Upper>() = upper.topLeftCorner(n, n);
  K.triangularView<Eigen::StrictlyLower>() = K.transpose();
  return K;
}

}  // namespace chladni::plate
