#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// Samples of functions of an angle, one function in each row: column s has the values at
/// 2 pi s / N, with N a power of two.
using AngleSamples = Eigen::MatrixXcd;
/// Fourier coefficients of f(phi) = sum_k c_k exp(i k phi): column k is c_k for k < N / 2, and
/// column N - k is c_-k.
using AngleHarmonics = Eigen::MatrixXcd;

/// The Fourier coefficients of samples.
AngleHarmonics harmonics_of(AngleSamples f);
/// The samples of a Fourier series.
AngleSamples samples_of(AngleHarmonics c);

/// The order k of a column among N harmonics, -N / 2 < k <= N / 2.
inline Eigen::Index order_of(Eigen::Index column, Eigen::Index N)
{
  return column <= N / 2 ? column : column - N;
}

/// The column of the order k among N harmonics.
inline Eigen::Index column_of(Eigen::Index k, Eigen::Index N)
{
  return k < 0 ? N + k : k;
}

/// The smallest power of two that is at least `n`.
Eigen::Index power_of_two(Eigen::Index n);

}  // namespace chladni::squeal
