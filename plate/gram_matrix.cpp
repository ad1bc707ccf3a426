#include <array>

#include "plate/strain_energy.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;

constexpr Index n_a = 4, n_b = 8;  // tiles that fit into the vector registers

/// K = R^T R on and above the diagonal, R [n_rows x n] and K [n x n] by rows, n a multiple of 8.
/// Compiled for several vector units, of which the machine at hand takes its own: this product is
/// most of the work of an element.
[[gnu::target_clones("arch=skylake-avx512", "arch=haswell", "default")]] void upper_gram(
    const double* __restrict R, Index n_rows, Index n, double* __restrict K)
{
  for (Index i = 0; i < n; i += n_a) {
    for (Index j = i / n_b * n_b; j < n; j += n_b) {
      std::array<std::array<double, n_b>, n_a> sum{};
      for (Index k = 0; k < n_rows; ++k) {
        const double* row = R + k * n;
        for (Index a = 0; a < n_a; ++a) {
          for (Index b = 0; b < n_b; ++b) sum[a][b] += row[i + a] * row[j + b];
        }
      }
      for (Index a = 0; a < n_a; ++a) {
        for (Index b = 0; b < n_b; ++b) K[(i + a) * n + j + b] = sum[a][b];
      }
    }
  }
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
  upper_gram(padded == n ? R.data() : wide.data(), R.rows(), padded, upper.data());
  Eigen::MatrixXd K(n, n);
  K.triangularView<Eigen::Upper>() = upper.topLeftCorner(n, n);
  K.triangularView<Eigen::StrictlyLower>() = K.transpose();
  return K;
}

}  // namespace chladni::plate
