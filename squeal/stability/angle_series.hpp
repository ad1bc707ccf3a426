#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// Functions of an angle, one in each row, by their values at N angles equally spaced over the
/// period, N a power of two: column s is that at 2 pi s / N.
using AngleSamples = Eigen::MatrixXcd;
/// f(phi) = sum_k c_k exp(i k phi): column k is c_k for k < N / 2, column N - k is c_-k.
using AngleHarmonics = Eigen::MatrixXcd;

AngleHarmonics harmonics_of(AngleSamples f);
AngleSamples samples_of(AngleHarmonics c);

/// k of a column of N harmonics, -N / 2 < k <= N / 2.
inline Eigen::Index order_of(Eigen::Index column, Eigen::Index N)
{
  return column <= N / 2 ? column : column - N;
}

/// The column of the harmonic k among N.
inline Eigen::Index column_of(Eigen::Index k, Eigen::Index N)
{
  return k < 0 ? N + k : k;
}

/// The smallest power of two that is at least `n`.
Eigen::Index power_of_two(Eigen::Index n);

}  // namespace chladni::squeal
