#include "linear/dense/products.hpp"

#include "linear/dense/avx2_products.hpp"

#if !EIGEN_VERSION_AT_LEAST(3, 4, 90)

namespace chladni::linear {
namespace {

using Eigen::Dynamic, Eigen::Index;

// Eigen's kernels are called by the names that its own products use: an expression would come
// back to `multiply`. A row of C is taken as the column of C^T = B^T A^T, and so is any C that
// stands in rows, so that below C stands in columns and each factor in columns or in rows.

/// Below this sum of m, n and k packing the factors costs more than the product: Eigen's measure.
constexpr Index small = 20;

template <typename Entry>
using Dense = Eigen::Matrix<Entry, Dynamic, Dynamic>;
template <typename Entry>
using Vector = Eigen::Matrix<Entry, Dynamic, 1>;
template <typename Matrix>
using Columns = Eigen::Map<Matrix, Eigen::Unaligned, Eigen::OuterStride<>>;
template <typename Vector>
using Spread = Eigen::Map<Vector, Eigen::Unaligned, Eigen::InnerStride<>>;

template <typename Entry>
StridedMatrix<Entry> transposed(const StridedMatrix<Entry>& A)
{
  return {A.values, A.n_columns, A.n_rows, A.column_step, A.row_step, A.is_conjugated};
}

template <typename Entry>
bool stands_in_columns(const StridedMatrix<Entry>& A)
{
  return A.row_step == 1 || A.n_rows == 1;
}

template <typename Entry>
bool stands_in_rows(const StridedMatrix<Entry>& A)
{
  return A.column_step == 1 || A.n_columns == 1;
}

/// Any matrix, of whatever steps.
template <typename Entry>
auto everywhere(const StridedMatrix<Entry>& A)
{
  using Matrix = std::conditional_t<std::is_const_v<Entry>, const Dense<std::remove_const_t<Entry>>,
                                    Dense<Entry>>;
  using Steps = Eigen::Stride<Dynamic, Dynamic>;
  return Eigen::Map<Matrix, Eigen::Unaligned, Steps>(A.values, A.n_rows, A.n_columns,
                                                     Steps(A.column_step, A.row_step));
}

/// A view of a matrix that stands in columns.
template <typename Entry>
auto in_columns(const StridedMatrix<Entry>& A)
{
  using Matrix = std::conditional_t<std::is_const_v<Entry>, const Dense<std::remove_const_t<Entry>>,
                                    Dense<Entry>>;
  return Columns<Matrix>(A.values, A.n_rows, A.n_columns, Eigen::OuterStride<>(A.column_step));
}

/// The only column of a matrix.
template <typename Entry>
auto column(const StridedMatrix<Entry>& A)
{
  using Of = std::conditional_t<std::is_const_v<Entry>, const Vector<std::remove_const_t<Entry>>,
                                Vector<Entry>>;
  return Spread<Of>(A.values, A.n_rows, Eigen::InnerStride<>(A.row_step));
}

double times(double a, double b)
{
  return a * b;
}

/// Without the question whether the numbers are finite.
std::complex<double> times(const std::complex<double>& a, const std::complex<double>& b)
{
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// C = factor A B or C <- C + factor A B by the definition, of any steps, none conjugated.
template <typename Entry>
void multiply_small(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& B,
                    Entry factor, Into into, const StridedMatrix<Entry>& C)
{
  for (Index j = 0; j < C.n_columns; ++j) {
    const Entry* b = B.values + j * B.column_step;
    Entry* c = C.values + j * C.column_step;
    for (Index i = 0; i < C.n_rows; ++i) {
      const Entry* a = A.values + i * A.row_step;
      Entry sum{};
      for (Index p = 0; p < A.n_columns; ++p) sum += times(a[p * A.column_step], b[p * B.row_step]);
      Entry& c_ij = c[i * C.row_step];
      c_ij = times(factor, sum) + (into == Into::added_to ? c_ij : Entry{});
    }
  }
}

/// y <- y + factor A x of vectors of any step.
template <typename Entry>
void add_matrix_vector(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& x,
                       Entry factor, const StridedMatrix<Entry>& y)
{
  using Eigen::ColMajor, Eigen::RowMajor, Eigen::OnTheRight;
  using Eigen::internal::gemv_dense_selector;
  auto y_view = column(y);
  const auto x_view = column(x);
  if (!stands_in_columns(A)) {
    gemv_dense_selector<OnTheRight, RowMajor, true>::run(in_columns(transposed(A)).transpose(),
                                                         x_view, y_view, factor);
    return;
  }
  if (y.row_step != 1) {
    gemv_dense_selector<OnTheRight, ColMajor, true>::run(in_columns(A), x_view, y_view, factor);
    return;
  }
  Eigen::Map<Vector<Entry>> y_contiguous(y.values, y.n_rows);
  gemv_dense_selector<OnTheRight, ColMajor, true>::run(in_columns(A), x_view, y_contiguous, factor);
}

template <typename Entry>
void add_vector(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& x,
                Entry factor, const StridedMatrix<Entry>& y)
{
  if (A.n_rows == 1) {
    *y.values += factor * column(transposed(A)).cwiseProduct(column(x)).sum();
    return;
  }
  add_matrix_vector(A, x, factor, y);
}

#ifdef __x86_64__
template <typename Entry>
RawFactor<Entry> columns_or_rows(const StridedMatrix<const Entry>& A, bool stands_in_columns)
{
  return {A.values, stands_in_columns ? A.column_step : A.row_step, stands_in_columns};
}
#endif

template <typename Entry, int order_A, int order_B>
void add_large(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& B,
               Entry factor, const StridedMatrix<Entry>& C)
{
#ifdef __x86_64__
  static const bool are_there = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (are_there) {
    add_product_by_avx2(columns_or_rows(A, order_A == Eigen::ColMajor),
                        columns_or_rows(B, order_B == Eigen::ColMajor), factor, C.values,
                        C.column_step, {C.n_rows, C.n_columns, A.n_columns});
    return;
  }
#endif
  const Index m = C.n_rows, n = C.n_columns, k = A.n_columns;
  Eigen::internal::gemm_blocking_space<Eigen::ColMajor, Entry, Entry, Dynamic, Dynamic, Dynamic>
      blocking(m, n, k, 1, true);
  Eigen::internal::general_matrix_matrix_product<
      Index, Entry, order_A, false, Entry, order_B, false, Eigen::ColMajor,
      1>::run(m, n, k, A.values, order_A == Eigen::ColMajor ? A.column_step : A.row_step, B.values,
              order_B == Eigen::ColMajor ? B.column_step : B.row_step, C.values, 1, C.column_step,
              factor, blocking, nullptr);
}

template <typename Entry>
void add_large(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& B,
               Entry factor, const StridedMatrix<Entry>& C)
{
  using Eigen::ColMajor, Eigen::RowMajor;
  if (stands_in_columns(A))
    if (stands_in_columns(B))
      add_large<Entry, ColMajor, ColMajor>(A, B, factor, C);
    else
      add_large<Entry, ColMajor, RowMajor>(A, B, factor, C);
  else if (stands_in_columns(B))
    add_large<Entry, RowMajor, ColMajor>(A, B, factor, C);
  else
    add_large<Entry, RowMajor, RowMajor>(A, B, factor, C);
}

/// Of factors and a C that stand in columns or in rows.
template <typename Entry>
void multiply_contiguous(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& B,
                         Entry factor, Into into, const StridedMatrix<Entry>& C)
{
  if (C.n_columns != 1 && (C.n_rows == 1 || !stands_in_columns(C))) {
    multiply_contiguous(transposed(B), transposed(A), factor, into, transposed(C));
    return;
  }
  if (into == Into::replaced) everywhere(C).setZero();
  if (C.n_columns == 1)
    add_vector(A, B, factor, C);
  else
    add_large(A, B, factor, C);
}

template <typename Entry>
bool is_contiguous(const StridedMatrix<Entry>& A)
{
  return stands_in_columns(A) || stands_in_rows(A);
}

template <typename Entry>
bool is_meant_as_it_stands(const StridedMatrix<Entry>& A)
{
  return !A.is_conjugated && is_contiguous(A);
}

/// What is meant by a factor, in a copy where it is a conjugate or stands neither in columns nor in
/// rows.
template <typename Entry>
class Factor {
 public:
  explicit Factor(const StridedMatrix<const Entry>& A) : meant_(A)
  {
    if (is_meant_as_it_stands(A)) return;
    copy_ = everywhere(A);
    if (A.is_conjugated) copy_ = copy_.conjugate();
    meant_ = {copy_.data(), A.n_rows, A.n_columns, 1, A.n_rows};
  }

  const StridedMatrix<const Entry>& meant() const { return meant_; }

 private:
  Dense<Entry> copy_;
  StridedMatrix<const Entry> meant_;
};

/// y = factor conj(A) x = factor conj(A conj(x)) copies a vector, not the matrix.
template <typename Entry>
void multiply_conjugate_by_vector(StridedMatrix<const Entry> A, StridedMatrix<const Entry> x,
                                  Entry factor, Into into, const StridedMatrix<Entry>& y)
{
  A.is_conjugated = false;
  x.is_conjugated = !x.is_conjugated;
  Vector<Entry> product(y.n_rows);
  multiply(A, x, Entry(1), Into::replaced,
           StridedMatrix<Entry>{product.data(), y.n_rows, 1, 1, y.n_rows});
  if (into == Into::replaced)
    column(y) = factor * product.conjugate();
  else
    column(y) += factor * product.conjugate();
}

template <typename Entry>
void multiply_copies(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& B,
                     Entry factor, Into into, const StridedMatrix<Entry>& C)
{
  const Factor<Entry> A_meant(A), B_meant(B);
  if (is_contiguous(C)) {
    multiply_contiguous(A_meant.meant(), B_meant.meant(), factor, into, C);
    return;
  }
  Dense<Entry> product = everywhere(C);
  multiply_contiguous(A_meant.meant(), B_meant.meant(), factor, into,
                      StridedMatrix<Entry>{product.data(), C.n_rows, C.n_columns, 1, C.n_rows});
  everywhere(C) = product;
}

template <typename Entry>
void multiply_any(const StridedMatrix<const Entry>& A, const StridedMatrix<const Entry>& B,
                  Entry factor, Into into, const StridedMatrix<Entry>& C)
{
  if (C.n_rows + C.n_columns + A.n_columns < small && !A.is_conjugated && !B.is_conjugated) {
    multiply_small(A, B, factor, into, C);
    return;
  }
  if (C.n_rows == 0 || C.n_columns == 0) return;
  if (A.n_columns == 0) {
    if (into == Into::replaced) everywhere(C).setZero();
    return;
  }
  if (C.n_columns == 1 && C.n_rows > 1 && A.is_conjugated) {
    multiply_conjugate_by_vector(A, B, factor, into, C);
    return;
  }
  if (C.n_rows == 1 && C.n_columns > 1 && B.is_conjugated) {
    multiply_conjugate_by_vector(transposed(B), transposed(A), factor, into, transposed(C));
    return;
  }
  if (is_meant_as_it_stands(A) && is_meant_as_it_stands(B) && is_contiguous(C))
    multiply_contiguous(A, B, factor, into, C);
  else
    multiply_copies(A, B, factor, into, C);
}

}  // namespace

void multiply(const StridedMatrix<const double>& A, const StridedMatrix<const double>& B,
              double factor, Into into, const StridedMatrix<double>& C)
{
  multiply_any(A, B, factor, into, C);
}

void multiply(const StridedMatrix<const std::complex<double>>& A,
              const StridedMatrix<const std::complex<double>>& B, std::complex<double> factor,
              Into into, const StridedMatrix<std::complex<double>>& C)
{
  multiply_any(A, B, factor, into, C);
}

}  // namespace chladni::linear

#endif
