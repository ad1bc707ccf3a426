#include "linear/kernels/sparse_product.hpp"

#include <algorithm>
#include <numeric>

#include "common/fitting_instructions.hpp"
#include "linear/kernels/as_aij.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

namespace {

constexpr PetscInt narrow = 8;  // columns of a panel: a cache line
constexpr PetscInt wide = 16;

struct Csr {
  const PetscInt* starts;
  const PetscInt* columns;
  const PetscScalar* values;
};

/// Y <- Y + A panel, Y row by row like the panel.
template <PetscInt width>
[[gnu::always_inline]] inline void add_panel(const Csr& A, PetscInt n_rows,
                                             const double* __restrict panel, double* __restrict Y)
{
  constexpr PetscInt ahead = 16;
  const PetscInt last = A.starts[n_rows] - 1;
  for (PetscInt i = 0; i < n_rows; ++i) {
    double sum[width];
    for (PetscInt c = 0; c < width; ++c) sum[c] = Y[std::size_t(i) * width + c];
    for (PetscInt k = A.starts[i]; k < A.starts[i + 1]; ++k) {
      // Rows of the panel stand far apart: ask for them early.
      const double* soon = panel + std::size_t(A.columns[std::min(k + ahead, last)]) * width;
      for (PetscInt line = 0; line < width; line += narrow) __builtin_prefetch(soon + line);
      const double a = A.values[k];
      const double* x = panel + std::size_t(A.columns[k]) * width;
      for (PetscInt c = 0; c < width; ++c) sum[c] += a * x[c];
    }
    for (PetscInt c = 0; c < width; ++c) Y[std::size_t(i) * width + c] = sum[c];
  }
}

CHLADNI_FITTING_INSTRUCTIONS
void add_narrow(const Csr& A, PetscInt n_rows, const double* panel, double* Y)
{
  add_panel<narrow>(A, n_rows, panel, Y);
}

CHLADNI_FITTING_INSTRUCTIONS
void add_wide(const Csr& A, PetscInt n_rows, const double* panel, double* Y)
{
  add_panel<wide>(A, n_rows, panel, Y);
}

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

SparseProduct::Rows SparseProduct::borrow(Mat sequential)
{
  Rows rows{.matrix = sequential};
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  petsc::check(
      MatGetRowIJ(sequential, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows.starts, &rows.columns, &done));
  if (!done)
    throw Error("SparseProduct: the matrix is not of type AIJ; convert it with MatConvert");
  petsc::check(MatSeqAIJGetArrayRead(sequential, &rows.values));
  return rows;
}

void SparseProduct::give_back(Rows& rows)
{
  if (rows.matrix == nullptr) return;
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  MatSeqAIJRestoreArrayRead(rows.matrix, &rows.values);
  MatRestoreRowIJ(rows.matrix, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows.starts, &rows.columns, &done);
}

SparseProduct::SparseProduct(Mat A) : A_(as_aij(A)), comm_(petsc::communicator(A))
{
  petsc::check(MatGetLocalSize(A, &n_rows_, &n_columns_));
  PetscBool is_distributed = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)(Mat)A_, MATMPIAIJ, &is_distributed));
  if (is_distributed) {
    Mat own = nullptr, other = nullptr;
    const PetscInt* ghosts = nullptr;
    petsc::check(MatMPIAIJGetSeqAIJ(A_, &own, &other, &ghosts));
    petsc::check(MatGetSize(other, nullptr, &n_ghosts_));
    own_ = borrow(own);
    other_ = borrow(other);
    const PetscInt* ranges = nullptr;
    petsc::check(MatGetOwnershipRangesColumn(A, &ranges));
    plan_exchange({.columns = ghosts, .first = ranges});
  } else {
    own_ = borrow(A_);
  }
  panel_ = aligned_numbers((std::size_t(n_columns_) + n_ghosts_) * wide);
  product_ = aligned_numbers(std::size_t(n_rows_) * wide);
}

SparseProduct::~SparseProduct()
{
  give_back(own_);
  give_back(other_);
}

/// Asks the owners for the ghosts, which ascend and so stand by rank.
void SparseProduct::plan_exchange(const Ghosts& ghosts)
{
  const int n_ranks = petsc::size(comm_);
  const int rank = petsc::rank(comm_);
  send_counts_.resize(n_ranks);
  receive_counts_.resize(n_ranks);
  for (int r = 0; r < n_ranks; ++r) {
    const PetscInt* end = ghosts.columns + n_ghosts_;
    receive_counts_[r] =
        static_cast<int>(std::lower_bound(ghosts.columns, end, ghosts.first[r + 1]) -
                         std::lower_bound(ghosts.columns, end, ghosts.first[r]));
  }
  MPI_Alltoall(receive_counts_.data(), 1, MPI_INT, send_counts_.data(), 1, MPI_INT, comm_);
  const std::vector<int> send_at = offsets(send_counts_), receive_at = offsets(receive_counts_);
  send_rows_.resize(send_at.back());
  MPI_Alltoallv(ghosts.columns, receive_counts_.data(), receive_at.data(), MPIU_INT,
                send_rows_.data(), send_counts_.data(), send_at.data(), MPIU_INT, comm_);
  for (int& row : send_rows_) row -= ghosts.first[rank];
  outbox_.resize(send_rows_.size() * wide);
}

/// The rows of the ghosts behind the own ones.
void SparseProduct::exchange(PetscInt width) const
{
  if (send_counts_.empty()) return;
  for (std::size_t i = 0; i < send_rows_.size(); ++i) {
    std::copy_n(panel_.get() + std::size_t(send_rows_[i]) * width, width,
                outbox_.data() + i * width);
  }
  const std::vector<int> send_at = offsets(send_counts_), receive_at = offsets(receive_counts_);
  const RowType row(width);
  MPI_Alltoallv(outbox_.data(), send_counts_.data(), send_at.data(), row,
                panel_.get() + std::size_t(n_columns_) * width, receive_counts_.data(),
                receive_at.data(), row, comm_);
}

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
    const auto add = width == wide ? add_wide : add_narrow;
    pack(x.values() + std::size_t(first) * x.leading_dimension(), x.leading_dimension(), n_columns_,
         n, width, panel_.get());
    exchange(width);
    std::fill_n(product_.get(), std::size_t(n_rows_) * width, 0.0);
    add({own_.starts, own_.columns, own_.values}, n_rows_, panel_.get(), product_.get());
    if (n_ghosts_ > 0) {
      add({other_.starts, other_.columns, other_.values}, n_rows_,
          panel_.get() + std::size_t(n_columns_) * width, product_.get());
    }
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
