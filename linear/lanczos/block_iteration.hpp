#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/lanczos/block_basis.hpp"

namespace chladni::linear {

/// Ritz values in the wanted order, and ||Op x - theta x||_M of each.
struct RitzValues {
  std::vector<double> theta, residual;
};

/// The Krylov space of some random vectors that are orthogonal to eigenvectors known before.
struct KrylovSequence {
  PetscInt n_sources = 0;  ///< number of random starting vectors
  PetscInt n_guesses = 0;  ///< of these, guesses of eigenvectors with a random part
  /// eigenvalues of the vectors known before, in the wanted order
  std::vector<double> known{};
};

/// What is known about further copies of multiple eigenvalues.
enum class Copies {
  all_there,      ///< no eigenvalue before the last one wanted has further copies
  not_yet_known,  ///< the sequence has not yet shown the largest eigenvalue besides the known ones
  may_lack        ///< an eigenvalue may have more copies than the sequence can find
};

/// Whether the first n pairs, all of them converged, may lack copies of a multiple eigenvalue. A
/// Krylov space of w random vectors holds min(m, w) eigenvectors of an eigenvalue of multiplicity
/// m, in addition to those known before. If fewer than w new ones were found, none is missing; if w
/// were found, there may be more. The cluster of the nth pair is not considered: further copies of
/// it would not change the first n values.
/// @param pairs      all pairs, in order
/// @param tolerance  of the residuals relative to theta; it determines how close eigenvalues are
///                   that converge as one
Copies copies_among(const RitzValues& pairs, PetscInt n, const KrylovSequence& sequence,
                    double tolerance);

/// The number of the first pairs that were known before the sequence began.
PetscInt n_known_among(std::span<const double> theta, const KrylovSequence& sequence,
                       double tolerance);

/// The number of leading pairs whose residual is at most the tolerance times |theta|.
PetscInt n_converged_first(const RitzValues& pairs, double tolerance);

/// A residual relative to theta. Above it, a restart that drops a pair makes the iteration forget
/// it; below it, a new sequence shows its largest eigenvalue.
constexpr double resolved = 1e-4;

/// A function Y <- Op Q for an operator that is self-adjoint in the inner product of M; M Q is
/// given.
using BlockOperator = std::function<void(Mat Q, Mat MQ, Mat Y)>;

/// Block Lanczos with full reorthogonalisation and thick restart, one step at a time, for any
/// operator self-adjoint in M: Op V = V T + Q R E_last^T + F with V^T M V = I. Ritz values are in
/// the order that the caller prefers, and the caller decides when to stop. F holds what the blocks
/// had along directions that were left out as dependent to round-off; random directions replace
/// them, so that blocks keep their width until the whole space is spanned.
/// Source: as `block_lanczos`.
class BlockIteration {
 public:
  /// Returns true if the Ritz value a comes before b.
  using Order = std::function<bool(double a, double b)>;

  /// @param capacity  largest number of basis vectors, the newest block included
  /// @param scratch   folder for files that hold them; empty: they are in memory
  BlockIteration(Mat M, PetscInt block_size, PetscInt capacity, const std::string& scratch = {});

  /// As BlockBasis. The operator must not lead to what is excluded either.
  void exclude(petsc::Matrix C) { basis_.exclude(std::move(C)); }
  /// Makes room for a larger basis.
  void reserve(PetscInt capacity) { basis_.reserve(capacity); }
  /// Starts with a deterministic block of random vectors, to which the operator is applied once.
  /// @throws chladni::Error when M maps it to zero.
  void start(const BlockOperator& op);
  /// Starts with guesses of eigenvectors in addition to the random vectors.
  /// @param guesses    dense; at most as many columns as a block, each the sum of some guesses
  /// @param n_guesses  number of all guesses
  void start(const BlockOperator& op, Mat guesses, PetscInt n_guesses);
  /// An empty dense matrix with the rows of M.
  petsc::Matrix new_block(PetscInt n_columns) const { return basis_.new_block(n_columns); }
  /// Gives memory back that only further steps need.
  void release_memory_of_steps() { basis_.release_given_back(); }
  /// Adds the newest block to V; the result of the operator on it becomes the newest block.
  void step(const BlockOperator& op);
  /// Solves the projected problem; fills `theta`.
  void order_ritz_values(const Order& before);
  /// Keeps the first `n` Ritz vectors and the newest block.
  /// @param n  at most n_vectors() - 1 and most_kept()
  void restart(PetscInt n);
  /// Keeps the first `n` Ritz vectors, which must have converged, and begins a new Krylov sequence
  /// with random vectors orthogonal to them, which finds what the old sequence cannot.
  /// @param width  new block size
  void begin_anew(PetscInt n, PetscInt width, const BlockOperator& op);

  PetscInt block_size() const { return block_size_; }
  PetscInt n_vectors() const { return n_old_; }
  bool is_full() const { return basis_.n_columns() + block_size_ > basis_.capacity(); }
  /// Largest number of Ritz vectors that a restart may keep, with room for a step after it.
  PetscInt most_kept() const { return basis_.capacity() - 2 * block_size_; }
  /// True if the subspace contains everything that M does not map to zero: its Ritz pairs are exact
  /// and it cannot grow.
  bool is_exhausted() const { return basis_.n_columns() == n_old_; }
  /// An upper estimate of the eigenvalues whose eigenvectors occurred in the blocks of this
  /// sequence but are not in the basis, because M times them has too few digits; 0 if there are
  /// none.
  double lost_theta() const { return lost_theta_; }
  /// Ritz value i in the order of the caller.
  double theta(PetscInt i) const { return ritz_.values[order_[i]]; }
  /// ||Op x - theta x||_M of Ritz pair i.
  double residual(PetscInt i) const;
  /// All Ritz values and residuals.
  RitzValues pairs() const;
  /// Whether the first n pairs, all converged, may lack copies of a multiple eigenvalue.
  Copies copies_among_first(PetscInt n, double tolerance) const;
  /// The sequence of random vectors that the newest block belongs to.
  const KrylovSequence& sequence() const { return sequence_; }
  /// Ritz vectors 0 .. n - 1, X^T M X = I; [n_rows x n] dense.
  petsc::Matrix ritz_vectors(PetscInt n) const;
  /// Ritz vectors first .. last - 1 after the step x <- Op x / theta, which removes the components
  /// that round-off brings in from the null space of a singular M. Use it for the largest |theta|
  /// only: small ones amplify such errors. If F is zero, the recurrence gives Op x without work;
  /// else it is computed.
  petsc::Matrix purified_vectors(PetscInt first, PetscInt last, const BlockOperator& op) const;

 private:
  /// Coefficients of Ritz vectors first .. last - 1 in (V, Q).
  Eigen::MatrixXd ritz_coefficients(PetscInt first, PetscInt last) const;
  /// Coefficients of Op x / theta in (V, Q), valid if F is zero.
  Eigen::MatrixXd purified_coefficients(PetscInt first, PetscInt last) const;
  petsc::Matrix applied_vectors(PetscInt first, PetscInt last, const BlockOperator& op) const;
  /// An upper bound of || F s || of Ritz pair i.
  double left_out(PetscInt i) const;
  /// Updates T, R and F after the first n Ritz vectors have replaced V.
  void take_ritz_values(PetscInt n);
  PetscInt append_random(PetscInt n, const BlockOperator& op);
  void note_lost(const BlockOperator& op);
  petsc::Matrix random_directions(PetscInt n);

  Mat M_;
  PetscInt block_size_;
  BlockBasis basis_;              ///< V, then the newest block Q
  PetscInt n_old_ = 0;            ///< columns of V
  Eigen::MatrixXd T_;             ///< [n_old x n_old]
  Eigen::MatrixXd R_;             ///< [columns of Q x columns of the last block of V]
  std::vector<double> left_out_;  ///< [n_old] lengths of the columns of F
  SymmetricEigen ritz_;
  std::vector<PetscInt> order_;
  PetscInt n_random_ = 0;  ///< random vectors made so far
  KrylovSequence sequence_;
  double lost_theta_ = 0.0;
  /// Restarts have dropped pairs that were found beyond the first so many pairs.
  PetscInt forgotten_from_ = PETSC_MAX_INT;
};

}  // namespace chladni::linear
