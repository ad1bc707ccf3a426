#include "linear/dense/rank_update.hpp"

#include <array>
#include <complex>

#include "common/fitting_instructions.hpp"

namespace chladni::linear {

namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

/// Some columns one after the other.
struct Columns {
  const double* values;
  Index n_rows, n_columns, leading_dimension;
};

/// a <- a - U s
CHLADNI_FITTING_INSTRUCTIONS
void subtract_from_column(const Columns& U, const double* s, double* __restrict a)
{
  const Index n = U.n_rows;
  Index c = 0;
  for (; c + 1 < U.n_columns; c += 2) {
    const double *u = U.values + c * U.leading_dimension, *next = u + U.leading_dimension;
    const double s_u = s[c], s_next = s[c + 1];
    for (Index i = 0; i < n; ++i) a[i] -= u[i] * s_u + next[i] * s_next;
  }
  if (c < U.n_columns) {
    const double* u = U.values + c * U.leading_dimension;
    for (Index i = 0; i < n; ++i) a[i] -= u[i] * s[c];
  }
}

/// Adds the squares of n numbers to as many sums. Returns the sum of all, side by side, so that the
/// compiler may use wide instructions.
CHLADNI_FITTING_INSTRUCTIONS
double add_squares(const double* a, Index n, double* __restrict squares)
{
  constexpr Index width = 16;
  std::array<double, width> sums{};
  Index i = 0;
  for (; i + width <= n; i += width) {
    for (Index k = 0; k < width; ++k) {
      const double square = a[i + k] * a[i + k];
      squares[i + k] += square;
      sums[std::size_t(k)] += square;
    }
  }
  double sum = 0.0;
  for (; i < n; ++i) {
    squares[i] += a[i] * a[i];
    sum += a[i] * a[i];
  }
  for (const double some : sums) sum += some;
  return sum;
}

/// The numbers of a complex matrix, real and imaginary parts in turn.
/// @return [2 rows x columns]
Eigen::Map<const MatrixXd> as_pairs(const MatrixXcd& A)
{
  return {reinterpret_cast<const double*>(A.data()), 2 * A.rows(), A.cols()};
}

/// Norms of the columns of A - U S, with the pairs of A, (u, i u) (Re s, Im s)^T.
/// @param column  of j: the numbers from the diagonal of A down, where U S is subtracted
template <typename Column>
VectorXd norms(const MatrixXcd& U, const MatrixXcd& S, const Column& column)
{
  const MatrixXcd i_U = std::complex<double>(0.0, 1.0) * U;
  MatrixXd left(2 * U.rows(), 2 * U.cols()), right(2 * U.cols(), S.cols());
  left << as_pairs(U), as_pairs(i_U);
  right << S.real(), S.imag();
  VectorXd of_rows = VectorXd::Zero(left.rows()), squares(S.cols());
  for (Index j = 0; j < S.cols(); ++j) {
    const Index first = 2 * j, n = left.rows() - first;
    double* a = column(j);
    subtract_from_column({left.data() + first, n, left.cols(), left.rows()}, right.col(j).data(),
                         a);
    // The rows before this column have been summed by now, and those of its diagonal are not yet.
    squares[j] = of_rows[first] + of_rows[first + 1];
    squares[j] += add_squares(a, n, of_rows.data() + first);
  }
  return squares.cwiseSqrt();
}

}  // namespace

VectorXd subtract_from_symmetric(const MatrixXcd& U, const MatrixXcd& S, MatrixXcd& A)
{
  return norms(U, S, [&](Index j) { return reinterpret_cast<double*>(&A(j, j)); });
}

VectorXd norms_without(const MatrixXcd& U, const MatrixXcd& S, const MatrixXcd& A)
{
  Eigen::VectorXcd column(A.rows());
  return norms(U, S, [&](Index j) {
    column.head(A.rows() - j) = A.col(j).tail(A.rows() - j);
    return reinterpret_cast<double*>(column.data());
  });
}

MatrixXcd symmetric_product(const MatrixXcd& A, const MatrixXd& B)
{
  return A.triangularView<Eigen::Lower>() * B.cast<std::complex<double>>() +
         A.triangularView<Eigen::StrictlyLower>().transpose() * B.cast<std::complex<double>>();
}

}  // namespace chladni::linear
