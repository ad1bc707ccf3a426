#include "linear/kernels/panel_product.hpp"

#include <algorithm>
#include <cstddef>

namespace chladni::linear {

namespace {

// The widest instructions of the processor at hand; Debian's baseline has two numbers in one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CHLADNI_FITTING_INSTRUCTIONS \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CHLADNI_FITTING_INSTRUCTIONS
#endif

template <PetscInt width>
[[gnu::always_inline]] inline void add_product_of_rows(const CsrArrays& A,
                                                       std::span<const PetscInt> rows,
                                                       const double* __restrict X,
                                                       double* __restrict Y)
{
  constexpr PetscInt ahead = 16;
  if (rows.empty()) return;
  const PetscInt last = A.starts[rows.back() + 1] - 1;
  for (const PetscInt i : rows) {
    double sum[width];
    for (PetscInt c = 0; c < width; ++c) sum[c] = Y[std::size_t(i) * width + c];
    for (PetscInt k = A.starts[i]; k < A.starts[i + 1]; ++k) {
      // Rows of the panel stand far apart: ask for them early.
      const double* soon = X + std::size_t(A.columns[std::min(k + ahead, last)]) * width;
      for (PetscInt line = 0; line < width; line += narrow_panel) __builtin_prefetch(soon + line);
      const double a = A.values[k];
      const double* x = X + std::size_t(A.columns[k]) * width;
      for (PetscInt c = 0; c < width; ++c) sum[c] += a * x[c];
    }
    for (PetscInt c = 0; c < width; ++c) Y[std::size_t(i) * width + c] = sum[c];
  }
}

}  // namespace

CHLADNI_FITTING_INSTRUCTIONS
void add_narrow_product(const CsrArrays& A, std::span<const PetscInt> rows, const double* X,
                        double* Y)
{
  add_product_of_rows<narrow_panel>(A, rows, X, Y);
}

CHLADNI_FITTING_INSTRUCTIONS
void add_wide_product(const CsrArrays& A, std::span<const PetscInt> rows, const double* X,
                      double* Y)
{
  add_product_of_rows<wide_panel>(A, rows, X, Y);
}

}  // namespace chladni::linear
