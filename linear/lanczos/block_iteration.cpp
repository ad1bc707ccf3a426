#include "linear/lanczos/block_iteration.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <span>

#include "common/eigen_every.hpp"
#include "linear/kernels/orthonormalisation.hpp"
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

PetscInt n_vectors_of(Mat X)
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
    if (n_vectors_of(Z) == 0) break;
    petsc::Matrix block = basis_.new_block(n_vectors_of(Z));
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
    const petsc::Matrix Y = basis_.new_block(n_vectors_of(X));
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
  petsc::Matrix X = basis_.new_block(n_vectors_of(guesses));
  fill_with_random_numbers(X, n_random_);
  n_random_ += n_vectors_of(guesses);
  normalise_columns(X, basis_.times_mass(X));
  petsc::check(MatScale(X, random_share));
  normalise_columns(guesses, basis_.times_mass(guesses));
  petsc::check(MatAXPY(X, 1.0, guesses, SAME_NONZERO_PATTERN));
  basis_.take_out_excluded(X);
  petsc::Matrix block = basis_.new_block(n_vectors_of(guesses));
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

// The vectors that a BlockIteration gives out.

MatrixXd BlockIteration::ritz_coefficients(PetscInt first, PetscInt last) const
{
  return ritz_.vectors(every, std::span(order_).subspan(first, last - first));
}

petsc::Matrix BlockIteration::ritz_vectors(PetscInt n) const
{
  return basis_.combine(ritz_coefficients(0, n));
}

MatrixXd BlockIteration::purified_coefficients(PetscInt first, PetscInt last) const
{
  MatrixXd S = MatrixXd::Zero(basis_.n_columns(), last - first);
  for (PetscInt k = 0; k < S.cols(); ++k) {
    const auto ritz = static_cast<PetscInt>(first + k);
    S.col(k).head(n_old_) = ritz_.vectors.col(order_[ritz]);
    for (PetscInt a = 0; a < basis_.n_columns() - n_old_; ++a) {
      for (PetscInt c = 0; c < R_.cols(); ++c) {
        S(n_old_ + a, k) +=
            R_(a, c) * ritz_.vectors(n_old_ - R_.cols() + c, order_[ritz]) / theta(ritz);
      }
    }
    double norm = 0.0;  // in the M-orthonormal basis
    for (PetscInt i = 0; i < S.rows(); ++i) norm += S(i, k) * S(i, k);
    S.col(k) /= std::sqrt(norm);
  }
  return S;
}

petsc::Matrix BlockIteration::purified_vectors(PetscInt first, PetscInt last,
                                               const BlockOperator& op) const
{
  const bool is_whole = std::ranges::all_of(left_out_, [](double length) { return length == 0.0; });
  if (is_whole) return basis_.combine(purified_coefficients(first, last));
  return applied_vectors(first, last, op);
}

/// By one true application of the operator. It amplifies what round-off a vector has of those with
/// larger |theta|, which is taken out again.
petsc::Matrix BlockIteration::applied_vectors(PetscInt first, PetscInt last,
                                              const BlockOperator& op) const
{
  constexpr PetscInt width = 32;
  const petsc::Matrix X = basis_.combine(ritz_coefficients(0, last));
  petsc::Matrix purified = basis_.new_vectors(last - first);
  for (PetscInt at = first; at < last; at += width) {
    const PetscInt end = std::min(at + width, last);
    const ColumnRange target(purified, at - first, end - first);
    {
      const ColumnRange some(X, at, end);
      op(some, basis_.times_mass(some), target);
    }
    MatrixXd C = inner_product(X, basis_.times_mass(target));
    for (PetscInt k = at; k < end; ++k) {
      for (PetscInt i = 0; i < last; ++i)
        if (std::abs(theta(i)) <= std::abs(theta(k))) C(i, k - at) = 0.0;
    }
    add_product(-1.0, X, C, target);
    normalise_columns(target, basis_.times_mass(target));
  }
  return purified;
}

namespace {

/// Whether two eigenvalues converge as one: a vector within the tolerance may mix their
/// eigenvectors.
class SameValue {
 public:
  SameValue(std::span<const double> theta, double tolerance)
      : gap_(std::clamp(100.0 * tolerance, 1e-8, 1e-4))
  {
    for (const double t : theta) round_off_ = std::max(round_off_, 1e-14 * std::abs(t));
  }
  /// Of all values.
  double round_off() const { return round_off_; }
  bool operator()(double a, double b) const
  {
    return std::abs(a - b) <= std::max(round_off_, gap_ * std::max(std::abs(a), std::abs(b)));
  }

 private:
  double gap_;
  double round_off_ = 0.0;
};

/// Both ascend in the same order: whether each of theta is the next of the known ones.
std::vector<bool> are_known(std::span<const double> theta, const KrylovSequence& sequence,
                            const SameValue& is_same)
{
  std::vector<bool> known(theta.size(), false);
  std::size_t next = 0;
  for (std::size_t i = 0; i < theta.size() && next < sequence.known.size(); ++i) {
    known[i] = is_same(theta[i], sequence.known[next]);
    if (known[i]) ++next;
  }
  return known;
}

PetscInt count(const std::vector<bool>& flags, PetscInt first, PetscInt last)
{
  return static_cast<PetscInt>(std::count(flags.begin() + first, flags.begin() + last, true));
}

/// Some cluster that ends before pair n has as many new members as the sequence has sources.
bool a_cluster_is_full(std::span<const double> theta, const std::vector<bool>& known,
                       PetscInt n_sources, const SameValue& is_same)
{
  const auto n = static_cast<PetscInt>(theta.size());
  for (PetscInt first = 0, last = 1; last < n; ++last) {
    if (is_same(theta[last - 1], theta[last])) continue;
    if (last - first - count(known, first, last) >= n_sources) return true;
    first = last;
  }
  return false;
}

}  // namespace

PetscInt n_converged_first(const RitzValues& pairs, double tolerance)
{
  std::size_t n = 0;
  while (n < pairs.theta.size() && pairs.residual[n] <= tolerance * std::abs(pairs.theta[n])) ++n;
  return static_cast<PetscInt>(n);
}

PetscInt n_known_among(std::span<const double> theta, const KrylovSequence& sequence,
                       double tolerance)
{
  const std::vector<bool> known = are_known(theta, sequence, {theta, tolerance});
  return count(known, 0, static_cast<PetscInt>(known.size()));
}

Copies copies_among(const RitzValues& pairs, PetscInt n, const KrylovSequence& sequence,
                    double tolerance)
{
  const std::span<const double> theta(pairs.theta.data(), n);
  const SameValue is_same(pairs.theta, tolerance);
  const std::vector<bool> known = are_known(theta, sequence, is_same);
  if (a_cluster_is_full(theta, known, sequence.n_sources, is_same)) return Copies::may_lack;
  const auto n_all = static_cast<PetscInt>(pairs.theta.size());
  const auto n_known = static_cast<PetscInt>(sequence.known.size());
  // The first that was neither known or guessed nor is among the n must show itself.
  const PetscInt n_to_show = n_known > 0               ? n_known + (n - count(known, 0, n)) + 1
                             : n <= sequence.n_guesses ? sequence.n_guesses + 1
                                                       : 0;
  const double relative = std::max(resolved, tolerance);
  for (PetscInt i = 0; i < std::min(n_to_show, n_all); ++i) {
    const double allowed = std::max(relative * std::abs(pairs.theta[i]), is_same.round_off());
    if (pairs.residual[i] > allowed) return Copies::not_yet_known;
  }
  return Copies::all_there;
}

}  // namespace chladni::linear
