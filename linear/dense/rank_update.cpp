#include "linear/dense/rank_update.hpp"

#include <array>

#include "common/fitting_instructions.hpp"

namespace chladni::linear {

namespace {

using Eigen::Index;

/// Some columns one after the other.
struct Columns {
  const double* values;
  Index n_rows, n_columns;
};

/// a <- a - U s
CHLADNI_FITTING_INSTRUCTIONS
void subtract_from_column(const Columns& U, const double* s, double* __restrict a)
{
  const Index n = U.n_rows;
  Index c = 0;
  for (; c + 1 < U.n_columns; c += 2) {
    const double *u = U.values + c * n, *next = u + n;
    const double s_u = s[c], s_next = s[c + 1];
    for (Index i = 0; i < n; ++i) a[i] -= u[i] * s_u + next[i] * s_next;
  }
  if (c < U.n_columns)
    for (Index i = 0; i < n; ++i) a[i] -= U.values[c * n + i] * s[c];
}

/// Side by side, so that the compiler may use wide instructions.
CHLADNI_FITTING_INSTRUCTIONS
double sum_of_squares(const double* a, Index n)
{
  constexpr Index width = 16;
  std::array<double, width> sums{};
  Index i = 0;
  for (; i + width <= n; i += width)
    for (Index k = 0; k < width; ++k) sums[std::size_t(k)] += a[i + k] * a[i + k];
  double sum = 0.0;
  for (; i < n; ++i) sum += a[i] * a[i];
  for (const double some : sums) sum += some;
  return sum;
}

}  // namespace

Eigen::VectorXd subtract_of_low_rank(const Eigen::MatrixXd& U, const Eigen::MatrixXd& S, double* A)
{
  Eigen::VectorXd squares(S.cols());
  for (Index j = 0; j < S.cols(); ++j) {
    double* a = A + j * U.rows();
    subtract_from_column({U.data(), U.rows(), U.cols()}, S.data() + j * S.rows(), a);
    squares[j] = sum_of_squares(a, U.rows());
  }
  return squares;
}

}  // namespace chladni::linear
