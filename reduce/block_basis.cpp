#include "reduce/block_basis.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "reduce/coefficients.hpp"
#include "reduce/log_event.hpp"
#include "reduce/machine_memory.hpp"
#include "reduce/orthonormalisation.hpp"
#include "reduce/tall_products.hpp"

namespace chladni::reduce {

namespace {

/// Y <- Y + alpha X S for column-major local rows.
void add_product(double alpha, const double* X, PetscInt n_local, const SmallMatrix& S, double beta,
                 double* Y)
{
  const PetscBLASInt m = n_local;
  const PetscBLASInt n = S.n_cols;
  const PetscBLASInt k = S.n_rows;
  if (m == 0 || n == 0 || k == 0) return;
  BLASgemm_("N", "N", &m, &n, &k, &alpha, X, &m, S.values.data(), &k, &beta, Y, &m);
}

/// Dense matrix on given storage, or on its own.
petsc::Matrix dense(MPI_Comm comm, PetscInt n_local, PetscInt n_global, PetscInt n_columns,
                    double* values)
{
  petsc::Matrix A;
  petsc::check(MatCreateDense(comm, n_local, PETSC_DECIDE, n_global, n_columns, values, A.put()));
  return A;
}

SmallMatrix product(const SmallMatrix& A, const SmallMatrix& B)
{
  SmallMatrix C(A.n_rows, B.n_cols);
  add_product(1.0, A.values.data(), A.n_rows, B, 0.0, C.values.data());
  return C;
}

/// What round-off in the columns of a block is relative to: their lengths before the projection.
std::vector<double> sizes(const SmallMatrix& G, const SmallMatrix& taken)
{
  std::vector<double> lengths = column_lengths(taken);
  for (PetscInt j = 0; j < G.n_cols; ++j) {
    lengths[j] = std::sqrt(lengths[j] * lengths[j] + std::max(G(j, j), 0.0));
    if (lengths[j] == 0.0) lengths[j] = 1.0;
  }
  return lengths;
}

/// Y <- Y - X S for local rows of X, Y.
void subtract_product(Mat X, const SmallMatrix& S, Mat Y)
{
  const LocalRows x(X);
  PetscScalar* y = nullptr;
  petsc::check(MatDenseGetArray(Y, &y));
  add_product(-1.0, x.values(), x.n_rows(), S, 1.0, y);
  petsc::check(MatDenseRestoreArray(Y, &y));
}

/// Whether a projection took more from some column than it left, G being the Gram matrix of what is
/// left (Daniel, Gragg, Kaufman and Stewart, Math. Comp. 30 (1976) 772).
bool is_large(const SmallMatrix& h, const SmallMatrix& G)
{
  for (PetscInt j = 0; j < h.n_cols; ++j) {
    double taken = 0.0;
    for (PetscInt i = 0; i < h.n_rows; ++i) taken += h(i, j) * h(i, j);
    if (taken > G(j, j)) return true;
  }
  return false;
}

}  // namespace

BlockBasis::BlockBasis(Mat M, PetscInt capacity) : M_(M), product_with_M_(M)
{
  petsc::check(MatGetLocalSize(M, &n_local_, nullptr));
  petsc::check(MatGetSize(M, &n_global_, nullptr));
  reserve(capacity);
}

void BlockBasis::reserve(PetscInt capacity)
{
  if (capacity <= capacity_) return;
  const double untouched = double(n_local_) * (capacity - n_columns_);
  require_memory(
      untouched * sizeof(double) / bytes_in_MiB,
      fmt::format("block Lanczos: a basis of {} vectors of {} DOFs", capacity, n_global_),
      "ask for fewer modes, use more machines or -cms_lanczos_subspace", petsc::communicator(M_));
  // Not a vector, which would touch all of it and, when it grows, hold it twice.
  const std::size_t n_bytes =
      std::max<std::size_t>(std::size_t(n_local_) * capacity, 1) * sizeof(double);
  void* larger = std::realloc(values_.get(), n_bytes);
  int refused = larger == nullptr ? 1 : 0;
  if (larger != nullptr) {
    static_cast<void>(values_.release());
    values_.reset(static_cast<double*>(larger));
  }
  MPI_Allreduce(MPI_IN_PLACE, &refused, 1, MPI_INT, MPI_MAX, petsc::communicator(M_));
  if (refused == 1) {
    throw Error(
        fmt::format("block Lanczos: no memory for {} vectors of {} DOFs; ask for fewer "
                    "modes, use more machines or -cms_lanczos_subspace",
                    capacity, n_global_));
  }
  capacity_ = capacity;
}

petsc::Matrix BlockBasis::new_block(PetscInt n_columns) const
{
  return uninitialized_dense(M_, n_columns);
}

petsc::Matrix BlockBasis::columns(PetscInt first, PetscInt n_columns)
{
  return dense(petsc::communicator(M_), n_local_, n_global_, n_columns,
               values_.get() + std::size_t(first) * n_local_);
}

petsc::Matrix BlockBasis::times_mass(Mat X) const
{
  petsc::Matrix MX = new_block(LocalRows(X).n_cols());
  product_with_M_.apply(X, MX);
  return MX;
}

/// block <- block - V_k V_k^T M block for the last two blocks V_k, the only large components in a
/// Lanczos recurrence; M_block follows without a product. Returns V^T M block, zero elsewhere.
SmallMatrix BlockBasis::project_out_newest(Mat block, Mat M_block)
{
  const LocalRows sizes(block);
  SmallMatrix h(n_columns_, sizes.n_cols());
  PetscInt end = n_columns_;
  for (const petsc::Matrix* M_V : {&newest_M_, &second_last_M_}) {
    if (*M_V == nullptr || end == 0) break;
    PetscInt n = 0;
    petsc::check(MatGetSize(*M_V, nullptr, &n));
    if (n == 0) continue;
    end -= n;
    const SmallMatrix h_k = inner_product(*M_V, block);
    subtract_product(columns(end, n), h_k, block);
    subtract_product(*M_V, h_k, M_block);
    for (PetscInt j = 0; j < h.n_cols; ++j) {
      for (PetscInt i = 0; i < n; ++i) h(end + i, j) = h_k(i, j);
    }
  }
  return h;
}

/// block <- block - V V^T M block; returns V^T M block.
SmallMatrix BlockBasis::project_out(Mat block, Mat M_block)
{
  if (n_columns_ == 0) return {0, LocalRows(block).n_cols()};
  const LongColumns V{values_.get(), n_local_, n_local_, n_columns_};
  const LocalRows rows(M_block);
  SmallMatrix h =
      tall_inner_product(V, {rows.values(), rows.leading_dimension(), n_local_, rows.n_cols()});
  sum_over_ranks(h, petsc::communicator(M_));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(block, &values));
  subtract_tall_product(V, h, values, n_local_);
  petsc::check(MatDenseRestoreArray(block, &values));
  return h;
}

/// X to_Q behind the basis, and M X to_Q as the newest.
void BlockBasis::store(Mat X, Mat MX, const SmallMatrix& to_Q)
{
  newest_M_ = new_block(to_Q.n_cols);
  PetscScalar* M_values = nullptr;
  petsc::check(MatDenseGetArrayWrite(newest_M_, &M_values));
  const LocalRows x(X);
  const LocalRows mx(MX);
  add_product(1.0, x.values(), n_local_, to_Q, 0.0,
              values_.get() + std::size_t(n_columns_) * n_local_);
  add_product(1.0, mx.values(), n_local_, to_Q, 0.0, M_values);
  petsc::check(MatDenseRestoreArrayWrite(newest_M_, &M_values));
}

BlockBasis::Appended BlockBasis::append(Mat block)
{
  const LogEvent event(Event::orthogonalization);
  petsc::Matrix M_block = times_mass(block);
  SmallMatrix h = project_out_newest(block, M_block);
  // What the other blocks still take away is round-off, and once is enough; where it is not, as
  // after a restart, twice is enough.
  SmallMatrix correction = project_out(block, M_block);
  M_block = times_mass(block);
  SmallMatrix G = inner_product(block, M_block);
  h = coefficient_sum(h, correction);
  if (is_large(correction, G)) {
    h = coefficient_sum(h, project_out(block, M_block));
    M_block = times_mass(block);
    G = inner_product(block, M_block);
  }
  const std::vector<double> lengths = sizes(G, h);
  second_last_M_ = std::move(newest_M_);
  Joined joined = join(block, M_block, G, lengths);
  if (joined.R.n_rows < G.n_cols) return look_again(block, M_block, joined, std::move(h), lengths);
  h = coefficient_sum(h, joined.coefficients);
  return {.coefficients = std::move(h),
          .R = std::move(joined.R),
          .left_out = std::vector(G.n_cols, 0.0)};
}

/// Q of block = Q R joins the basis, with what orthogonality Q lacked in the coefficients.
BlockBasis::Joined BlockBasis::join(Mat block, Mat M_block, const SmallMatrix& G,
                                    const std::vector<double>& sizes)
{
  constexpr double dependent = 1e-13;  // round-off with room
  const Orthonormalisation o = orthonormalisation(G, sizes, dependent, comm());
  reserve(n_columns_ + o.R.n_rows);  // a second look may find more directions than the block has
  Joined joined{.coefficients = {n_columns_, G.n_cols}, .R = o.R, .left_out = o.left_out};
  store(block, M_block, o.to_Q);
  // Short directions were amplified together with their round-off: clean them once more.
  // One that loses most of its length then was round-off only.
  constexpr double genuine = 0.3;
  constexpr double harmless = 30.0;  // loses 900 eps of orthonormality
  if (o.condition > harmless || o.shortest < 1e-3) {
    petsc::Matrix Q;
    petsc::check(MatDuplicate(columns(n_columns_, o.R.n_rows), MAT_COPY_VALUES, Q.put()));
    joined.coefficients = product(project_out(Q, newest_M_), o.R);
    petsc::Matrix MQ = times_mass(Q);
    const std::vector<double> units(o.R.n_rows, 1.0);
    const Orthonormalisation again =
        orthonormalisation(inner_product(Q, MQ), units, genuine, comm());
    store(Q, MQ, again.to_Q);
    joined.left_out = stacked(joined.left_out, product(again.left_out, o.R));
    joined.R = product(again.R, o.R);
  }
  n_columns_ += joined.R.n_rows;
  return joined;
}

/// The squares in a Gram matrix hide directions shorter than the root of round-off behind longer
/// ones. With these taken out of the block, what is left of it shows whether there are others.
BlockBasis::Appended BlockBasis::look_again(Mat block, Mat M_block, const Joined& first,
                                            SmallMatrix h, const std::vector<double>& lengths)
{
  const PetscInt n_before = h.n_rows;
  h = stacked(h, SmallMatrix(first.R.n_rows, first.R.n_cols));
  petsc::Matrix MX;
  for (int pass = 0; pass < 2; ++pass) {
    h = coefficient_sum(h, project_out(block, pass == 0 ? M_block : Mat(MX)));
    MX = times_mass(block);
  }
  const Joined second = join(block, MX, inner_product(block, MX), lengths);
  h = coefficient_sum(h, second.coefficients);
  SmallMatrix R = stacked(row_range(h, n_before, h.n_rows), second.R);
  unite_newest(R.n_rows);
  return {.coefficients = row_range(h, 0, n_before),
          .R = std::move(R),
          .left_out = column_lengths(second.left_out)};
}

void BlockBasis::truncate(PetscInt n)
{
  n_columns_ = n;
  newest_M_ = {};
  second_last_M_ = {};
}

void BlockBasis::unite_newest(PetscInt n)
{
  second_last_M_ = {};
  newest_M_ = times_mass(columns(n_columns_ - n, n));
}

void BlockBasis::compress(const SmallMatrix& S, PetscInt n_first)
{
  constexpr PetscInt piece = 512;  // rows at a time, in place
  std::vector<double> rows(std::size_t(piece) * n_first);
  for (PetscInt at = 0; at < n_local_; at += piece) {
    const PetscInt n = std::min(piece, n_local_ - at);
    for (PetscInt j = 0; j < n_first; ++j) {
      std::copy_n(values_.get() + at + std::size_t(j) * n_local_, n,
                  rows.data() + std::size_t(j) * n);
    }
    const PetscBLASInt m = n, columns = S.n_cols, k = n_first, ld = n_local_;
    const PetscScalar one = 1.0, zero = 0.0;
    BLASgemm_("N", "N", &m, &columns, &k, &one, rows.data(), &m, S.values.data(), &k, &zero,
              values_.get() + at, &ld);
  }
  const PetscInt n_behind = n_columns_ - n_first;
  std::copy_n(values_.get() + std::size_t(n_first) * n_local_, std::size_t(n_behind) * n_local_,
              values_.get() + std::size_t(S.n_cols) * n_local_);
  n_columns_ = S.n_cols + n_behind;
  second_last_M_ = {};
}

petsc::Matrix BlockBasis::combine(const SmallMatrix& S) const
{
  petsc::Matrix X = new_block(S.n_cols);
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X, &values));
  add_product(1.0, values_.get(), n_local_, S, 0.0, values);
  petsc::check(MatDenseRestoreArrayWrite(X, &values));
  return X;
}

}  // namespace chladni::reduce
