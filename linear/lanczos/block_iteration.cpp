#include "linear/lanczos/block_iteration.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <span>

#include "linear/kernels/columns_with_mass.hpp"
#include "linear/kernels/random_block.hpp"
#include "linear/kernels/small_matrices.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

/// T bordered by the coefficients of a new block; symmetric by taking means.
MatrixXd bordered(const MatrixXd& T, const MatrixXd& coefficients)
{
  const Eigen::Index n_old = T.rows(), n = coefficients.rows();
  MatrixXd result(n, n);
  result.topLeftCorner(n_old, n_old) = T;
  for (Eigen::Index j = n_old; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double here = coefficients(i, j - n_old);
      const double there = i >= n_old ? coefficients(j, i - n_old) : here;
      result(i, j) = result(j, i) = 0.5 * (here + there);
    }
  }
  return result;
}

PetscInt n_columns_of(Mat X)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(X, nullptr, &n));
  return n;
}

}  // namespace

BlockIteration::BlockIteration(Mat M, PetscInt block_size, PetscInt capacity,
                               const std::string& scratch)
    : M_(M), block_size_(block_size), basis_(M, capacity, scratch)
{}

/// Random vectors that are orthonormal in M and orthogonal to the basis: fewer than n where the
/// space has no more.
petsc::Matrix BlockIteration::random_directions(PetscInt n)
{
  petsc::Matrix Z = basis_.new_block(n);
  fill_with_random_numbers(Z, n_random_);
  n_random_ += n;
  basis_.take_out_excluded(Z);
  if (basis_.n_columns() == 0) return Z;  // the operator takes it as it is
  const PetscInt n_before = basis_.n_columns();
  const auto n_new = static_cast<PetscInt>(basis_.append(Z).R.rows());
  petsc::Matrix found = basis_.new_block(0);
  if (n_new > 0)
    found = columns_with_mass(basis_.columns(n_before, n_new), basis_.newest_times_mass(), M_);
  basis_.truncate(n_before);
  return found;
}

/// Up to n random vectors, once through the operator, join the basis and become the newest block
/// together with as many of those before that make up the rest of it. Returns their number.
PetscInt BlockIteration::append_random(PetscInt n, const BlockOperator& op)
{
  const PetscInt n_before = basis_.n_columns();
  while (basis_.n_columns() < n_before + n) {
    const petsc::Matrix Z = random_directions(n_before + n - basis_.n_columns());
    if (n_columns_of(Z) == 0) break;
    petsc::Matrix block = basis_.new_block(n_columns_of(Z));
    op(Z, basis_.times_mass(Z), block);
    // An operator may map to zero what is not in the basis.
    if (basis_.append(block).R.rows() == 0 && basis_.append(Z).R.rows() == 0) break;
  }
  note_lost(op);
  return basis_.n_columns() - n_before;
}

/// Directions of unit length in M that are orthogonal to a basis which the operator hardly leaves
/// are sums of eigenvectors with eigenvalues up to the lengths that it gives them.
void BlockIteration::note_lost(const BlockOperator& op)
{
  for (const petsc::Matrix& X : basis_.take_lost()) {
    const petsc::Matrix Y = basis_.new_block(n_columns_of(X));
    op(X, basis_.times_mass(X), Y);
    std::vector<double> squares = column_products(Y, basis_.times_mass(Y));
    broadcast_numbers(squares, basis_.comm());
    for (const double square : squares)
      lost_theta_ = std::max(lost_theta_, std::sqrt(std::max(square, 0.0)));
  }
}

void BlockIteration::start(const BlockOperator& op)
{
  block_size_ = std::min(block_size_, basis_.n_rows());
  append_random(block_size_ - basis_.n_columns(), op);
  sequence_.n_sources = basis_.n_columns();
  if (basis_.n_columns() == 0)
    throw Error("block Lanczos: the start vectors have no mass; is the mass matrix zero?");
  basis_.unite_newest(basis_.n_columns());
}

void BlockIteration::start(const BlockOperator& op, Mat guesses, PetscInt n_guesses)
{
  // Exact guesses span a space that the operator does not leave, so that nothing else would be
  // found: each gets a share of a random vector.
  constexpr double random_share = 1e-3;
  petsc::Matrix X = basis_.new_block(n_columns_of(guesses));
  fill_with_random_numbers(X, n_random_);
  n_random_ += n_columns_of(guesses);
  normalise_columns(X, basis_.times_mass(X));
  petsc::check(MatScale(X, random_share));
  normalise_columns(guesses, basis_.times_mass(guesses));
  petsc::check(MatAXPY(X, 1.0, guesses, SAME_NONZERO_PATTERN));
  basis_.take_out_excluded(X);
  petsc::Matrix block = basis_.new_block(n_columns_of(guesses));
  op(X, basis_.times_mass(X), block);
  basis_.append(block);
  sequence_.n_guesses = n_guesses;
  start(op);
}

void BlockIteration::step(const BlockOperator& op)
{
  assert(!is_full());
  const PetscInt n_new = basis_.n_columns() - n_old_;
  petsc::Matrix block = basis_.take_block(n_new);
  op(basis_.columns(n_old_, n_new), basis_.newest_times_mass(), block);
  n_old_ = basis_.n_columns();
  const BlockBasis::Appended appended = basis_.append(block);
  basis_.give_back(std::move(block));
  note_lost(op);
  T_ = bordered(T_, appended.coefficients);
  left_out_.insert(left_out_.end(), appended.left_out.begin(), appended.left_out.end());
  R_ = appended.R;
  if (R_.rows() == block_size_) return;
  const auto n_genuine = static_cast<PetscInt>(R_.rows());
  const PetscInt n_random = append_random(block_size_ - n_genuine, op);
  R_ = stacked(R_, MatrixXd::Zero(n_random, R_.cols()));  // these come from no recurrence
  basis_.unite_newest(n_genuine + n_random);
}

void BlockIteration::order_ritz_values(const Order& before)
{
  ritz_ = symmetric_eigen(T_, basis_.comm());
  if (!std::ranges::all_of(ritz_.values, [](double theta) { return std::isfinite(theta); })) {
    throw Error(
        "block Lanczos: its projected matrix is not finite; check that M is positive semidefinite "
        "and that K and M hold no infinity or NaN");
  }
  order_.resize(n_old_);
  std::iota(order_.begin(), order_.end(), 0);
  std::ranges::stable_sort(
      order_, [&](PetscInt a, PetscInt b) { return before(ritz_.values[a], ritz_.values[b]); });
}

double BlockIteration::left_out(PetscInt i) const
{
  double sum = 0.0;
  for (PetscInt k = 0; k < n_old_; ++k)
    sum += std::pow(left_out_[k] * ritz_.vectors(k, order_[i]), 2);
  return std::sqrt(sum);
}

double BlockIteration::residual(PetscInt i) const
{
  double sum = std::pow(left_out(i), 2);
  for (PetscInt a = 0; a < R_.rows(); ++a) {
    double component = 0.0;
    for (PetscInt c = 0; c < R_.cols(); ++c)
      component += R_(a, c) * ritz_.vectors(n_old_ - R_.cols() + c, order_[i]);
    sum += component * component;
  }
  return std::sqrt(sum);
}

RitzValues BlockIteration::pairs() const
{
  RitzValues pairs;
  for (PetscInt i = 0; i < n_old_; ++i) {
    pairs.theta.push_back(theta(i));
    pairs.residual.push_back(residual(i));
  }
  return pairs;
}

Copies BlockIteration::copies_among_first(PetscInt n, double tolerance) const
{
  if (is_exhausted()) return Copies::all_there;
  if (n > forgotten_from_) return Copies::may_lack;
  return copies_among(pairs(), n, sequence_, tolerance);
}

void BlockIteration::take_ritz_values(PetscInt n)
{
  std::vector<double> thetas, left;
  MatrixXd T = MatrixXd::Zero(n, n), R = MatrixXd::Zero(R_.rows(), n);
  for (PetscInt k = 0; k < n; ++k) {
    thetas.push_back(theta(k));
    left.push_back(left_out(k));
    T(k, k) = theta(k);
    for (PetscInt c = 0; c < R_.cols(); ++c) {
      const double s = ritz_.vectors(n_old_ - R_.cols() + c, order_[k]);
      for (PetscInt a = 0; a < R_.rows(); ++a) R(a, k) += R_(a, c) * s;
    }
  }
  T_ = std::move(T);
  R_ = std::move(R);
  left_out_ = std::move(left);
  ritz_ = {.values = std::move(thetas), .vectors = MatrixXd::Identity(n, n)};
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0);
  n_old_ = n;
}

void BlockIteration::restart(PetscInt n)
{
  n = std::min(n, most_kept());
  const RitzValues all = pairs();
  for (PetscInt i = n; i < n_old_; ++i) {
    const bool was_found = all.residual[i] <= resolved * std::abs(all.theta[i]);
    if (was_found) forgotten_from_ = std::min(forgotten_from_, n);
  }
  const std::span<const double> kept(all.theta.data(), n);
  sequence_.known.resize(n_known_among(kept, sequence_, resolved));
  basis_.compress(ritz_coefficients(0, n), n_old_);
  take_ritz_values(n);
}

void BlockIteration::begin_anew(PetscInt n, PetscInt width, const BlockOperator& op)
{
  const RitzValues all = pairs();
  basis_.truncate(n_old_);
  basis_.compress(ritz_coefficients(0, n), n_old_);
  take_ritz_values(n);
  left_out_.assign(all.residual.begin(), all.residual.begin() + n);
  sequence_.n_guesses = 0;
  lost_theta_ = 0.0;
  sequence_.known.assign(all.theta.begin(), all.theta.begin() + n);
  forgotten_from_ = PETSC_MAX_INT;
  block_size_ = width;
  sequence_.n_sources = append_random(width, op);
  R_ = MatrixXd(sequence_.n_sources, 0);
  basis_.unite_newest(sequence_.n_sources);
}

}  // namespace chladni::linear
