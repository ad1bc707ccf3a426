#include "linear/lanczos/block_basis.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/eigen_every.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/panel_kernels.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/storage.hpp"
#include "linear/log_event.hpp"
#include "linear/machine_memory.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

/// Dense matrix on given storage, or on its own.
petsc::Matrix dense(MPI_Comm comm, PetscInt n_local, PetscInt n_global, PetscInt n_columns,
                    double* values)
{
  petsc::Matrix A;
  petsc::check(MatCreateDense(comm, n_local, PETSC_DECIDE, n_global, n_columns, values, A.put()));
  return A;
}

}  // namespace

BlockBasis::BlockBasis(Mat M, PetscInt capacity, std::string scratch)
    : M_(M), product_with_M_(M), scratch_(std::move(scratch)), values_(scratch_)
{
  petsc::check(MatGetLocalSize(M, &n_local_, nullptr));
  petsc::check(MatGetSize(M, &n_global_, nullptr));
  reserve(capacity);
}

void BlockBasis::reserve(PetscInt capacity)
{
  if (capacity <= capacity_) return;
  if (scratch_.empty()) {
    const double untouched = double(n_local_) * (capacity - n_columns_);
    require_memory(
        untouched * sizeof(double) / bytes_in_MiB,
        fmt::format("block Lanczos: a basis of {} vectors of {} DOFs", capacity, n_global_),
        "ask for fewer modes, use more machines, -cms_scratch or -cms_lanczos_subspace",
        petsc::communicator(M_));
  }
  int lack = int(values_.grow(std::size_t(n_local_) * capacity));
  MPI_Allreduce(MPI_IN_PLACE, &lack, 1, MPI_INT, MPI_MAX, petsc::communicator(M_));
  if (Lack(lack) != Lack::none) {
    const std::string what = fmt::format("{} vectors of {} DOFs", capacity, n_global_);
    throw Error("block Lanczos: " + told(Lack(lack), what,
                                         "ask for fewer modes or a smaller -cms_lanczos_subspace",
                                         scratch_));
  }
  capacity_ = capacity;
}

petsc::Matrix BlockBasis::new_block(Eigen::Index n_columns) const
{
  return uninitialized_dense(M_, n_columns);
}

petsc::Matrix BlockBasis::take_block(Eigen::Index n_columns)
{
  if (spare_.empty() || LocalRows(spare_.back()).n_cols() != n_columns) return new_block(n_columns);
  petsc::Matrix block = std::move(spare_.back());
  spare_.pop_back();
  return block;
}

void BlockBasis::give_back(petsc::Matrix block)
{
  constexpr std::size_t most = 2;
  if (block == nullptr) return;
  const bool is_alike =
      spare_.empty() || LocalRows(spare_.back()).n_cols() == LocalRows(block).n_cols();
  if (!is_alike) spare_.clear();
  if (spare_.size() < most) spare_.push_back(std::move(block));
}

petsc::Matrix BlockBasis::new_vectors(Eigen::Index n_columns) const
{
  return large_dense(M_, static_cast<PetscInt>(n_columns), scratch_);
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

void BlockBasis::compress(const Eigen::MatrixXd& S, PetscInt n_first)
{
  constexpr PetscInt piece = 512;  // rows at a time, in place
  std::vector<double> rows(std::size_t(piece) * n_first);
  const auto n_kept = static_cast<PetscInt>(S.cols());
  for (PetscInt at = 0; at < n_local_; at += piece) {
    const PetscInt n = std::min(piece, n_local_ - at);
    for (PetscInt j = 0; j < n_first; ++j) {
      std::copy_n(values_.get() + at + std::size_t(j) * n_local_, n,
                  rows.data() + std::size_t(j) * n);
    }
    const PetscBLASInt m = n, columns = n_kept, k = n_first, ld = n_local_;
    const PetscScalar one = 1.0, zero = 0.0;
    BLASgemm_("N", "N", &m, &columns, &k, &one, rows.data(), &m, S.data(), &k, &zero,
              values_.get() + at, &ld);
  }
  const PetscInt n_behind = n_columns_ - n_first;
  std::copy_n(values_.get() + std::size_t(n_first) * n_local_, std::size_t(n_behind) * n_local_,
              values_.get() + std::size_t(n_kept) * n_local_);
  n_columns_ = n_kept + n_behind;
  second_last_M_ = {};
}

petsc::Matrix BlockBasis::combine(const Eigen::MatrixXd& S) const
{
  petsc::Matrix X = new_vectors(S.cols());
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X, &values));
  add_product(1.0, values_.get(), n_local_, S, 0.0, values);
  petsc::check(MatDenseRestoreArrayWrite(X, &values));
  return X;
}

// How a block of vectors joins a BlockBasis.

namespace {

/// What round-off in the columns of a block is relative to: their lengths before the projection.
std::vector<double> sizes_of_columns(const MatrixXd& G, const MatrixXd& taken)
{
  std::vector<double> lengths = column_lengths(taken);
  for (PetscInt j = 0; j < G.cols(); ++j) {
    lengths[j] = std::sqrt(lengths[j] * lengths[j] + std::max(G(j, j), 0.0));
    if (lengths[j] == 0.0) lengths[j] = 1.0;
  }
  return lengths;
}

LongColumns long_columns(const LocalRows& X)
{
  return {.values = X.values(),
          .leading_dimension = X.leading_dimension(),
          .n_rows = X.n_rows(),
          .n_columns = X.n_cols()};
}

/// X^T Y of the rows of this rank, for few columns X.
MatrixXd narrow_inner_product(Mat X, Mat Y)
{
  const LocalRows x(X), y(Y);
  return tall_inner_product(long_columns(x), long_columns(y));
}

/// X^T M X, on every rank.
MatrixXd narrow_gram(Mat X, Mat MX)
{
  MatrixXd G = narrow_inner_product(X, MX);
  sum_over_ranks(values_of(G), petsc::communicator(X));
  return G;
}

/// Whether a projection took more from some column than it left, G being the Gram matrix of what is
/// left (Daniel, Gragg, Kaufman and Stewart, Math. Comp. 30 (1976) 772).
bool is_large(const MatrixXd& h, const MatrixXd& G)
{
  for (PetscInt j = 0; j < h.cols(); ++j) {
    double taken = 0.0;
    for (PetscInt i = 0; i < h.rows(); ++i) taken += h(i, j) * h(i, j);
    if (taken > G(j, j)) return true;
  }
  return false;
}

}  // namespace

/// block <- block - V_k V_k^T M block for the last two blocks V_k, the only large components in a
/// Lanczos recurrence. Returns V^T M block, zero elsewhere.
MatrixXd BlockBasis::project_out_newest(Mat block)
{
  MatrixXd h = MatrixXd::Zero(n_columns_, LocalRows(block).n_cols());
  PetscInt first = n_columns_;
  for (const petsc::Matrix* M_V : {&newest_M_, &second_last_M_}) {
    if (*M_V == nullptr || first == 0) break;
    const MatrixXd h_k = narrow_inner_product(*M_V, block);
    first -= static_cast<PetscInt>(h_k.rows());
    h.middleRows(first, h_k.rows()) = h_k;
  }
  MatrixXd taken = h.bottomRows(n_columns_ - first);
  sum_over_ranks(values_of(taken), comm());
  subtract_columns(first, taken, block);
  h.bottomRows(n_columns_ - first) = taken;
  return h;
}

/// block <- block - V S with the columns of the basis from the first one given on.
void BlockBasis::subtract_columns(PetscInt first, const MatrixXd& S, Mat block) const
{
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(block, &values));
  subtract_tall_product(local_columns(first), S, values, n_local_);
  petsc::check(MatDenseRestoreArray(block, &values));
}

/// The columns of the basis from the first one given on.
LongColumns BlockBasis::local_columns(PetscInt first) const
{
  return {.values = values_.get() + std::size_t(first) * n_local_,
          .leading_dimension = n_local_,
          .n_rows = n_local_,
          .n_columns = n_columns_ - first};
}

void BlockBasis::take_out_excluded(Mat block) const
{
  if (excluded_ != nullptr)
    add_product(-1.0, excluded_, inner_product(excluded_, times_mass(block)), block);
}

/// block <- block - V V^T M block, without what is excluded; returns V^T M block.
MatrixXd BlockBasis::project_out(Mat block, Mat M_block)
{
  if (excluded_ != nullptr) add_product(-1.0, excluded_, inner_product(excluded_, M_block), block);
  if (n_columns_ == 0) return MatrixXd(0, LocalRows(block).n_cols());
  const LocalRows rows(M_block);
  MatrixXd h = tall_inner_product(local_columns(0), long_columns(rows));
  sum_over_ranks(values_of(h), comm());
  subtract_columns(0, h, block);
  return h;
}

/// X to_Q behind the basis, and M X to_Q as the newest.
void BlockBasis::store(Mat X, Mat MX, const MatrixXd& to_Q)
{
  give_back(std::move(newest_M_));
  newest_M_ = take_block(to_Q.cols());
  PetscScalar* M_values = nullptr;
  petsc::check(MatDenseGetArrayWrite(newest_M_, &M_values));
  const LocalRows x(X);
  const LocalRows mx(MX);
  tall_product(long_columns(x), to_Q, values_.get() + std::size_t(n_columns_) * n_local_, n_local_);
  tall_product(long_columns(mx), to_Q, M_values, n_local_);
  petsc::check(MatDenseRestoreArrayWrite(newest_M_, &M_values));
}

BlockBasis::Appended BlockBasis::append(Mat block)
{
  const LogEvent event(Event::orthogonalization);
  MatrixXd h = project_out_newest(block);
  petsc::Matrix M_block = take_block(h.cols());
  product_with_M_.apply(block, M_block);
  // What the other blocks still take away is round-off, and once is enough; where it is not, as
  // after a restart, twice is enough.
  const MatrixXd correction = project_out(block, M_block);
  product_with_M_.apply(block, M_block);
  MatrixXd G = narrow_gram(block, M_block);
  h += correction;
  if (is_large(correction, G)) {
    h += project_out(block, M_block);
    product_with_M_.apply(block, M_block);
    G = narrow_gram(block, M_block);
  }
  const std::vector<double> lengths = sizes_of_columns(G, h);
  give_back(std::move(second_last_M_));
  second_last_M_ = std::move(newest_M_);
  Joined joined = join(block, M_block, G, lengths);
  if (joined.R.rows() < G.cols()) return look_again(block, M_block, joined, std::move(h), lengths);
  give_back(std::move(M_block));
  h += joined.coefficients;
  return {.coefficients = std::move(h),
          .R = std::move(joined.R),
          .left_out = std::vector(G.cols(), 0.0)};
}

/// A direction of negative length in M, beyond the round-off of its terms, is one of an indefinite
/// M. Left out as dependent it would end the iteration with too few pairs. Its length is computed
/// anew: the Gram matrix has the round-off of the columns that cancel in it.
void BlockBasis::refuse_negative_length(Mat block, const Orthonormalisation& o) const
{
  constexpr double round_off = 1e-9, of_gram_matrix = 1e-10;
  if (!(o.least_square < -of_gram_matrix)) return;
  const petsc::Matrix x = new_block(1);
  petsc::check(MatZeroEntries(x));
  add_product(1.0, block, o.least_direction, x);
  const double terms = value_of_first_rank(diagonal_terms(x, M_)[0], comm());
  const double square = value_of_first_rank(column_products(x, times_mass(x))[0], comm());
  if (square >= -round_off * std::abs(terms)) return;
  throw Error(
      fmt::format("block Lanczos: x^T M x = {:.3g} for a vector x with sum M_ii x_i^2 = {:.3g}: M "
                  "(B of an EPS), the matrix of the inner product, is indefinite; it must be "
                  "positive semidefinite",
                  square, terms));
}

/// Q of block = Q R joins the basis, with what orthogonality Q lacked in the coefficients.
BlockBasis::Joined BlockBasis::join(Mat block, Mat M_block, const MatrixXd& G,
                                    const std::vector<double>& sizes)
{
  constexpr double dependent = 1e-13;  // round-off with room
  constexpr double harmless = 30.0;    // loses 900 eps of orthonormality
  const Orthonormalisation o = orthonormalisation(G, sizes, dependent, comm());
  refuse_negative_length(block, o);
  // A second look may find more directions than the block has.
  reserve(n_columns_ + static_cast<PetscInt>(o.R.rows()));
  Joined joined{
      .coefficients = MatrixXd::Zero(n_columns_, G.cols()), .R = o.R, .left_out = o.left_out};
  store(block, M_block, o.to_Q);
  if (o.condition > harmless || o.shortest < 1e-3) clean(joined);
  n_columns_ += static_cast<PetscInt>(joined.R.rows());
  return joined;
}

/// Short directions were amplified together with their round-off, and so was M times them: they are
/// made orthonormal once more. Left out are those that were round-off only, which lose most of
/// their length then, and those that lie in the null space of M but for round-off, in which M times
/// them is lost.
void BlockBasis::clean(Joined& joined)
{
  constexpr double genuine = 0.3;
  petsc::Matrix Q;
  petsc::check(MatDuplicate(columns(n_columns_, static_cast<PetscInt>(joined.R.rows())),
                            MAT_COPY_VALUES, Q.put()));
  joined.coefficients = product(project_out(Q, times_mass(Q)), joined.R);
  const petsc::Matrix MQ = times_mass(Q);
  const std::vector<double> units(joined.R.rows(), 1.0);
  const Orthonormalisation o = orthonormalisation(inner_product(Q, MQ), units, genuine, comm());
  store(Q, MQ, o.to_Q);
  MatrixXd left_out = o.left_out, R = o.R;
  const Chosen chosen = by_digits_of_mass(static_cast<PetscInt>(o.R.rows()));
  if (!chosen.others.empty()) {
    const MatrixXd to_lost = o.to_Q(every, chosen.unsure);
    if (to_lost.cols() > 0) {
      lost_.push_back(new_block(to_lost.cols()));
      petsc::check(MatZeroEntries(lost_.back()));
      add_product(1.0, Q, to_lost, lost_.back());
    }
    store(Q, MQ, o.to_Q(every, chosen.resolved));
    left_out = stacked(left_out, o.R(chosen.others, every));
    R = o.R(chosen.resolved, every);
  }
  joined.left_out = stacked(joined.left_out, product(left_out, joined.R));
  joined.R = product(R, joined.R);
}

/// Of the n columns behind the basis, of unit length in M.
BlockBasis::Chosen BlockBasis::by_digits_of_mass(PetscInt n)
{
  constexpr double eps = std::numeric_limits<double>::epsilon();
  constexpr double enough = 1e-6 / eps, two_digits = 1e-2 / eps;
  std::vector<double> terms = diagonal_terms(columns(n_columns_, n), M_);
  broadcast_numbers(terms, comm());
  Chosen chosen;
  for (PetscInt k = 0; k < n; ++k) {
    (terms[k] < enough ? chosen.resolved : chosen.others).push_back(k);
    if (terms[k] >= enough && terms[k] < two_digits) chosen.unsure.push_back(k);
  }
  return chosen;
}

/// The squares in a Gram matrix hide directions shorter than the root of round-off behind longer
/// ones. With these taken out of the block, what is left of it shows whether there are others.
BlockBasis::Appended BlockBasis::look_again(Mat block, Mat M_block, const Joined& first, MatrixXd h,
                                            const std::vector<double>& lengths)
{
  const Eigen::Index n_before = h.rows();
  h = stacked(h, MatrixXd::Zero(first.R.rows(), first.R.cols()));
  petsc::Matrix MX;
  for (int pass = 0; pass < 2; ++pass) {
    h += project_out(block, pass == 0 ? M_block : Mat(MX));
    MX = times_mass(block);
  }
  const Joined second = join(block, MX, inner_product(block, MX), lengths);
  h += second.coefficients;
  MatrixXd R = stacked(h.bottomRows(h.rows() - n_before), second.R);
  unite_newest(static_cast<PetscInt>(R.rows()));
  return {.coefficients = h.topRows(n_before),
          .R = std::move(R),
          .left_out = column_lengths(second.left_out)};
}

}  // namespace chladni::linear
