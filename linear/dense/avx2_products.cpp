#include "linear/dense/avx2_products.hpp"

// Eigen's product kernel once more, compiled for another processor than the rest of the program.
// Functions of one name must be one function, so that Eigen has another name here; CMake gives this
// source neither the precompiled header nor others beside it.
#define Eigen EigenOfAvx2
#include <Eigen/Core>

namespace chladni::linear {
namespace {

using Eigen::ColMajor, Eigen::Dynamic, Eigen::RowMajor;

template <int order_A, int order_B, typename Entry>
void add_ordered(const RawFactor<Entry>& A, const RawFactor<Entry>& B, Entry factor, Entry* C,
                 std::ptrdiff_t step, const ProductSize& size)
{
  Eigen::internal::gemm_blocking_space<ColMajor, Entry, Entry, Dynamic, Dynamic, Dynamic> blocking(
      size.m, size.n, size.k, 1, true);
  Eigen::internal::general_matrix_matrix_product<Eigen::Index, Entry, order_A, false, Entry,
                                                 order_B, false, ColMajor, 1>::run(size.m, size.n,
                                                                                   size.k, A.values,
                                                                                   A.step, B.values,
                                                                                   B.step, C, 1,
                                                                                   step, factor,
                                                                                   blocking,
                                                                                   nullptr);
}

template <typename Entry>
void add_any(const RawFactor<Entry>& A, const RawFactor<Entry>& B, Entry factor, Entry* C,
             std::ptrdiff_t step, const ProductSize& size)
{
  if (A.stands_in_columns && B.stands_in_columns)
    add_ordered<ColMajor, ColMajor>(A, B, factor, C, step, size);
  else if (A.stands_in_columns)
    add_ordered<ColMajor, RowMajor>(A, B, factor, C, step, size);
  else if (B.stands_in_columns)
    add_ordered<RowMajor, ColMajor>(A, B, factor, C, step, size);
  else
    add_ordered<RowMajor, RowMajor>(A, B, factor, C, step, size);
}

}  // namespace

void add_product_by_avx2(const RawFactor<double>& A, const RawFactor<double>& B, double factor,
                         double* C, std::ptrdiff_t step, const ProductSize& size)
{
  add_any(A, B, factor, C, step, size);
}

void add_product_by_avx2(const RawFactor<std::complex<double>>& A,
                         const RawFactor<std::complex<double>>& B, std::complex<double> factor,
                         std::complex<double>* C, std::ptrdiff_t step, const ProductSize& size)
{
  add_any(A, B, factor, C, step, size);
}

}  // namespace chladni::linear
