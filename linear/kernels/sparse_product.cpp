#include "linear/kernels/sparse_product.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "linear/kernels/as_aij.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/panel_product.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

namespace {

constexpr PetscInt narrow = narrow_panel, wide = wide_panel;

/// n columns, row by row, the rest of the width zero.
void pack(const double* X, PetscInt ldx, PetscInt n_rows, PetscInt n, PetscInt width, double* panel)
{
  for (PetscInt i = 0; i < n_rows; ++i) {
    double* row = panel + std::size_t(i) * width;
    for (PetscInt c = 0; c < n; ++c) row[c] = X[i + std::size_t(c) * ldx];
    for (PetscInt c = n; c < width; ++c) row[c] = 0.0;
  }
}

/// The first n columns out of a panel.
void unpack(const double* panel, PetscInt width, PetscInt n_rows, PetscInt n, double* Y,
            PetscInt ldy)
{
  for (PetscInt i = 0; i < n_rows; ++i)
    for (PetscInt c = 0; c < n; ++c)
      Y[i + std::size_t(c) * ldy] = panel[std::size_t(i) * width + c];
}

}  // namespace

namespace {

std::vector<PetscInt> all_rows(Mat A)
{
  PetscInt n = 0;
  petsc::check(MatGetLocalSize(A, &n, nullptr));
  std::vector<PetscInt> rows(static_cast<std::size_t>(n));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

}  // namespace

SparseProduct::SparseProduct(Mat A) : SparseProduct(A, all_rows(A)) {}

SparseProduct::SparseProduct(Mat A, std::vector<PetscInt> rows)
    : A_(as_aij(A)), rows_(std::move(rows))
{
  petsc::check(MatGetLocalSize(A, &n_rows_, nullptr));
  const OwnAndOther parts = own_and_other(A_);
  own_.emplace(parts.own);
  if (parts.other != nullptr) {
    other_.emplace(parts.other);
    const PetscInt* ranges = nullptr;
    petsc::check(MatGetOwnershipRanges(A, &ranges));
    ghosts_ = GhostRows(std::span(parts.ghosts, std::size_t(parts.n_ghosts)), ranges,
                        petsc::communicator(A));
  }
  panel_ = aligned_numbers((std::size_t(n_rows_) + ghosts_.size()) * wide);
  product_ = aligned_numbers(std::size_t(n_rows_) * wide);
}

SparseProduct::~SparseProduct() = default;

void SparseProduct::apply(Mat X, Mat Y) const
{
  const LogEvent event(Event::sparse_product);
  const LocalRows x(X);
  PetscInt ldy = 0;
  PetscScalar* y = nullptr;
  petsc::check(MatDenseGetLDA(Y, &ldy));
  petsc::check(MatDenseGetArrayWrite(Y, &y));
  for (PetscInt first = 0; first < x.n_cols();) {
    const PetscInt width = x.n_cols() - first > narrow ? wide : narrow;
    const PetscInt n = std::min(width, x.n_cols() - first);
    const auto add = width == wide ? add_wide_product : add_narrow_product;
    pack(x.values() + std::size_t(first) * x.leading_dimension(), x.leading_dimension(), n_rows_, n,
         width, panel_.get());
    double* ghosts = panel_.get() + std::size_t(n_rows_) * width;
    ghosts_.take(panel_.get(), width, ghosts);
    std::fill_n(product_.get(), std::size_t(n_rows_) * width, 0.0);
    add(own_->arrays(), rows_, panel_.get(), product_.get());
    if (other_) add(other_->arrays(), rows_, ghosts, product_.get());
    unpack(product_.get(), width, n_rows_, n, y + std::size_t(first) * ldy, ldy);
    first += n;
  }
  petsc::check(MatDenseRestoreArrayWrite(Y, &y));
}

petsc::Matrix sparse_product(Mat A, Mat X)
{
  petsc::Matrix AX = uninitialized_dense(A, LocalRows(X).n_cols());
  SparseProduct(A).apply(X, AX);
  return AX;
}

}  // namespace chladni::linear
