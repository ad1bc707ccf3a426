#pragma once

#include <Eigen/Core>
#include <concepts>

// Products of dense matrices of doubles or of complex numbers, compiled once in products.cpp. Eigen
// fills in its products anew for each expression, with a version for small, for large and for thin
// factors: that was a third of what the compiler did. Every source is given this header by CMake
// (chladni_compile) and writes `C.noalias() += A.transpose() * B` as ever; programs
// without it get the same products from Eigen.
// docs/explanation/decisions/0011-products-are-compiled-once.md has what was measured. Products of
// small fixed sizes stay expressions, and so do all products of an Eigen after 3.4, whose kernels
// may have other names.

namespace chladni::linear {

/// Entries (i, j) of a matrix or a vector at values[i * row_step + j * column_step]. One of the
/// steps is 1, but for a vector.
template <typename Entry>
struct StridedMatrix {
  Entry* values;
  Eigen::Index n_rows, n_columns;
  Eigen::Index row_step, column_step;
  bool is_conjugated = false;  ///< the conjugate of the entries is meant
};

/// What becomes of the entries that were there.
enum class Into { replaced, added_to };

/// C = factor A B, or C <- C + factor A B. C shares no entry with A or B.
/// @param A  [m x k]
/// @param B  [k x n]
/// @param C  [m x n], not conjugated
void multiply(const StridedMatrix<const double>& A, const StridedMatrix<const double>& B,
              double factor, Into into, const StridedMatrix<double>& C);
void multiply(const StridedMatrix<const std::complex<double>>& A,
              const StridedMatrix<const std::complex<double>>& B, std::complex<double> factor,
              Into into, const StridedMatrix<std::complex<double>>& C);

/// Where the entries of a matrix stand.
template <typename Matrix>
auto strided(const Matrix& A, bool is_conjugated)
{
  return StridedMatrix<const typename Matrix::Scalar>{A.data(),      A.rows(),      A.cols(),
                                                      A.rowStride(), A.colStride(), is_conjugated};
}

/// Both factors have entries of the one kind that `multiply` takes.
template <typename Left, typename Right>
concept Multipliable = std::same_as<typename Left::Scalar, typename Right::Scalar> &&
    (std::same_as<typename Left::Scalar, double> ||
     std::same_as<typename Left::Scalar, std::complex<double>>);

/// A product that Eigen would evaluate by large or thin factors, by `multiply`.
template <typename Left, typename Right>
struct CompiledProduct {
  using Entry = typename Left::Scalar;

  // NOLINTBEGIN(readability-identifier-naming): the names by which Eigen calls them
  template <typename Target>
  static void evalTo(Target& C, const Left& A, const Right& B)
  {
    run(C, A, B, Entry(1), Into::replaced);
  }
  template <typename Target>
  static void addTo(Target& C, const Left& A, const Right& B)
  {
    run(C, A, B, Entry(1), Into::added_to);
  }
  template <typename Target>
  static void subTo(Target& C, const Left& A, const Right& B)
  {
    run(C, A, B, Entry(-1), Into::added_to);
  }
  template <typename Target>
  static void scaleAndAddTo(Target& C, const Left& A, const Right& B, const Entry& factor)
  {
    run(C, A, B, factor, Into::added_to);
  }
  // NOLINTEND(readability-identifier-naming)

 private:
  // What stands in memory, without its factor, transposed or conjugated; a copy of anything else.
  template <typename Factor>
  using Stored = typename Eigen::internal::blas_traits<Factor>::DirectLinearAccessType;

  template <typename Target>
  static void run(Target& C, const Left& A, const Right& B, Entry factor, Into into)
  {
    using OfA = Eigen::internal::blas_traits<Left>;
    using OfB = Eigen::internal::blas_traits<Right>;
    const Stored<Left> stored_A(OfA::extract(A));
    const Stored<Right> stored_B(OfB::extract(B));
    multiply(strided(stored_A, OfA::NeedToConjugate), strided(stored_B, OfB::NeedToConjugate),
             factor * OfA::extractScalarFactor(A) * OfB::extractScalarFactor(B), into,
             {C.data(), C.rows(), C.cols(), C.rowStride(), C.colStride()});
  }
};

}  // namespace chladni::linear

#if !EIGEN_VERSION_AT_LEAST(3, 4, 90)

namespace Eigen::internal {

template <typename Left, typename Right>
requires chladni::linear::Multipliable<Left, Right>
struct generic_product_impl<Left, Right, DenseShape, DenseShape, GemmProduct>
    : chladni::linear::CompiledProduct<Left, Right> {
};

template <typename Left, typename Right>
requires chladni::linear::Multipliable<Left, Right>
struct generic_product_impl<Left, Right, DenseShape, DenseShape, GemvProduct>
    : chladni::linear::CompiledProduct<Left, Right> {
};

}  // namespace Eigen::internal

#endif
