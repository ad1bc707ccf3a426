#include "squeal/stability/angle_series.hpp"

#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

void reverse_bits(Eigen::MatrixXcd& f)
{
  const Eigen::Index N = f.cols();
  for (Eigen::Index i = 1, j = 0; i < N; ++i) {
    Eigen::Index bit = N / 2;
    for (; j & bit; bit /= 2) j ^= bit;
    j ^= bit;
    if (i < j) f.col(i).swap(f.col(j));
  }
}

/// sum_s f_s exp(sign 2 pi i k s / N) for all k at once (Cooley and Tukey).
Eigen::MatrixXcd transformed(Eigen::MatrixXcd f, double sign)
{
  const Eigen::Index N = f.cols();
  assert(N > 0 && (N & (N - 1)) == 0);
  reverse_bits(f);
  Eigen::VectorXcd turned(f.rows());
  for (Eigen::Index half = 1; half < N; half *= 2)
    for (Eigen::Index k = 0; k < half; ++k) {
      const Complex factor = std::polar(1.0, sign * std::numbers::pi * double(k) / double(half));
      for (Eigen::Index i = k; i < N; i += 2 * half) {
        turned.noalias() = factor * f.col(i + half);
        f.col(i + half) = f.col(i) - turned;
        f.col(i) += turned;
      }
    }
  return f;
}

}  // namespace

AngleHarmonics harmonics_of(AngleSamples f)
{
  AngleHarmonics c = transformed(std::move(f), -1.0);
  c *= 1.0 / double(c.cols());
  return c;
}

AngleSamples samples_of(AngleHarmonics c)
{
  return transformed(std::move(c), 1.0);
}

Eigen::Index power_of_two(Eigen::Index n)
{
  Eigen::Index power = 1;
  while (power < n) power *= 2;
  return power;
}

}  // namespace chladni::squeal
