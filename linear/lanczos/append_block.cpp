// How a block of vectors joins a BlockBasis.
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/eigen_every.hpp"
#include "linear/kernels/columns_with_mass.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/tall_products.hpp"
#include "linear/lanczos/block_basis.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

/// What round-off in the columns of a block is relative to: their lengths before the projection.
std::vector<double> sizes(const MatrixXd& G, const MatrixXd& taken)
{
  std::vector<double> lengths = column_lengths(taken);
  for (PetscInt j = 0; j < G.cols(); ++j) {
    lengths[j] = std::sqrt(lengths[j] * lengths[j] + std::max(G(j, j), 0.0));
    if (lengths[j] == 0.0) lengths[j] = 1.0;
  }
  return lengths;
}

/// Y <- Y - X S for local rows of X, Y.
void subtract_product(Mat X, const MatrixXd& S, Mat Y)
{
  const LocalRows x(X);
  PetscScalar* y = nullptr;
  petsc::check(MatDenseGetArray(Y, &y));
  add_product(-1.0, x.values(), x.n_rows(), S, 1.0, y);
  petsc::check(MatDenseRestoreArray(Y, &y));
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
/// Lanczos recurrence; M_block follows without a product. Returns V^T M block, zero elsewhere.
MatrixXd BlockBasis::project_out_newest(Mat block, Mat M_block)
{
  const LocalRows sizes(block);
  MatrixXd h = MatrixXd::Zero(n_columns_, sizes.n_cols());
  PetscInt end = n_columns_;
  for (const petsc::Matrix* M_V : {&newest_M_, &second_last_M_}) {
    if (*M_V == nullptr || end == 0) break;
    PetscInt n = 0;
    petsc::check(MatGetSize(*M_V, nullptr, &n));
    if (n == 0) continue;
    end -= n;
    const MatrixXd h_k = inner_product(*M_V, block);
    subtract_product(columns(end, n), h_k, block);
    subtract_product(*M_V, h_k, M_block);
    h.middleRows(end, n) = h_k;
  }
  return h;
}

/// block <- block - V V^T M block; returns V^T M block.
MatrixXd BlockBasis::project_out(Mat block, Mat M_block)
{
  if (n_columns_ == 0) return MatrixXd(0, LocalRows(block).n_cols());
  const LongColumns V{values_.get(), n_local_, n_local_, n_columns_};
  const LocalRows rows(M_block);
  MatrixXd h =
      tall_inner_product(V, {rows.values(), rows.leading_dimension(), n_local_, rows.n_cols()});
  sum_over_ranks(values_of(h), petsc::communicator(M_));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(block, &values));
  subtract_tall_product(V, h, values, n_local_);
  petsc::check(MatDenseRestoreArray(block, &values));
  return h;
}

/// X to_Q behind the basis, and M X to_Q as the newest.
void BlockBasis::store(Mat X, Mat MX, const MatrixXd& to_Q)
{
  newest_M_ = new_block(to_Q.cols());
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
  MatrixXd h = project_out_newest(block, M_block);
  // What the other blocks still take away is round-off, and once is enough; where it is not, as
  // after a restart, twice is enough.
  const MatrixXd correction = project_out(block, M_block);
  M_block = times_mass(block);
  MatrixXd G = inner_product(block, M_block);
  h += correction;
  if (is_large(correction, G)) {
    h += project_out(block, M_block);
    M_block = times_mass(block);
    G = inner_product(block, M_block);
  }
  const std::vector<double> lengths = sizes(G, h);
  second_last_M_ = std::move(newest_M_);
  Joined joined = join(block, M_block, G, lengths);
  if (joined.R.rows() < G.cols()) return look_again(block, M_block, joined, std::move(h), lengths);
  h += joined.coefficients;
  return {.coefficients = std::move(h),
          .R = std::move(joined.R),
          .left_out = std::vector(G.cols(), 0.0)};
}

/// Q of block = Q R joins the basis, with what orthogonality Q lacked in the coefficients.
BlockBasis::Joined BlockBasis::join(Mat block, Mat M_block, const MatrixXd& G,
                                    const std::vector<double>& sizes)
{
  constexpr double dependent = 1e-13;  // round-off with room
  constexpr double harmless = 30.0;    // loses 900 eps of orthonormality
  const Orthonormalisation o = orthonormalisation(G, sizes, dependent, comm());
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
