#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "linear/lanczos/block_iteration.hpp"

namespace chladni::linear {

/// A function X <- K^-1 B for dense B and X.
using BlockSolve = std::function<void(Mat B, Mat X)>;

struct BlockLanczosOptions {
  /// number of wanted pairs
  PetscInt n_pairs;
  /// a column of a block costs 5 to 8 times less than a single solve
  PetscInt block_size = 8;
  /// largest basis before a restart; 0 = 2.25 n_pairs + 24 blocks
  PetscInt max_subspace = 0;
  /// largest number of block solves
  PetscInt max_steps = 1000;
  double tolerance = 1e-9;  ///< residual of K^-1 M x = theta x relative to theta, in the M norm
  /// folder for files that hold the basis and the vectors; empty: they are in memory
  std::string scratch = {};
};

/// Eigenpairs of lowest lambda of K x = lambda M x, ascending, X^T M X = I.
struct EigenPairs {
  std::vector<double> lambda;    ///< [k] with k >= n_pairs unless fewer exist
  std::vector<double> residual;  ///< [k] relative, as in `tolerance`
  petsc::Matrix X;               ///< [n x k] dense
  PetscInt n_solves;             ///< columns solved with the factor
};

/// An upper limit of lambda that includes all eigenvalues.
inline constexpr double all_of_them = std::numeric_limits<double>::infinity();

/// Block Lanczos for K^-1 M with full reorthogonalisation in the M inner product and thick restart.
/// It continues where it stopped when more pairs are asked for. A Krylov space holds no more copies
/// of a multiple eigenvalue than it has starting vectors; if that many were found, a new sequence
/// begins with random vectors orthogonal to all converged pairs, until fewer are found
/// (`copies_among`). M may be singular: Ritz vectors are purified by the step x <- K^-1 M x /
/// theta, which the recurrence already contains. Starting vectors depend on the global row only, so
/// the result depends on the number of ranks only by round-off.
/// Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; thick restart: Wu and
/// Simon, SIAM J. Matrix Anal. Appl. 22 (2000) 602; purification: Nour-Omid, Parlett, Ericsson and
/// Jensen, Math. Comp. 48 (1987) 663.
class BlockLanczos {
 public:
  /// @param factor   Cholesky factor of K, for MatMatSolve; must outlive this object
  /// @param options  without n_pairs
  BlockLanczos(Mat factor, Mat M, const BlockLanczosOptions& options);
  BlockLanczos(BlockSolve solve, Mat M, const BlockLanczosOptions& options);
  BlockLanczos(const BlockLanczos&) = delete;
  BlockLanczos& operator=(const BlockLanczos&) = delete;

  /// Iterates until the lowest n_pairs have converged, or all if there are fewer.
  /// @note   Collective.
  /// @throws chladni::Error when they do not within `max_steps`.
  void converge(PetscInt n_pairs);
  /// Iterates until all pairs up to lambda have converged, and one more, which shows that they are
  /// all; or the lowest `most`. How many there are need not be known.
  /// @param lambda  rad^2/s^2
  /// @note   Collective.
  /// @throws chladni::Error as `converge`.
  void converge_beyond(double lambda, PetscInt most);

  /// Checks that all pairs below lambda have converged.
  /// @param lambda  rad^2/s^2
  /// @throws chladni::Error when pairs below lambda may be missing because round-off hides them.
  void require_resolved(double lambda) const;
  /// rad^2/s^2; above this lambda there may be pairs that do not converge, as far as `converge` has
  /// come. Infinity if there are none.
  double unresolved_from() const { return unresolved_from_; }

  /// Number of converged pairs.
  PetscInt n_pairs() const { return n_converged_; }
  /// Number of columns solved with the factor so far.
  PetscInt n_solves() const { return n_solves_; }
  double lambda(PetscInt i) const { return 1.0 / iteration_.theta(i); }
  /// The relative residual of a pair, as in BlockLanczosOptions::tolerance.
  double residual(PetscInt i) const { return iteration_.residual(i) / iteration_.theta(i); }
  /// X of the pairs first .. last - 1, orthonormal in M.
  /// @note   Collective.
  petsc::Matrix vectors(PetscInt first, PetscInt last) const
  {
    return iteration_.purified_vectors(first, last, op_);
  }

 private:
  /// How far to converge: the lowest n_pairs, and of the first `most` those up to lambda and one
  /// more.
  struct Goal {
    PetscInt n_pairs;
    double lambda = 0.0;
    PetscInt most = 0;
  };
  void converge(Goal goal);
  void iterate(Goal goal);
  void raise(Goal& goal);
  bool has_converged(Goal& goal);
  bool has_ended(const RitzValues& pairs, PetscInt n_pairs);
  void note_unresolved(double theta);
  bool is_too_early(PetscInt n_pairs) const;
  void restart(PetscInt n_pairs);
  void begin_anew(PetscInt n_kept, PetscInt n_pairs);

  BlockSolve solve_;
  BlockLanczosOptions options_;
  PetscInt n_rows_ = 0;
  BlockOperator op_;
  BlockIteration iteration_;
  PetscInt n_converged_ = 0;
  PetscInt n_solves_ = 0;
  PetscInt next_look_ = 0;  ///< number of basis vectors at the next check
  /// Pairs kept by the last sequence that began from an exhausted basis.
  PetscInt n_kept_before_ = 0;
  double unresolved_from_ = all_of_them;  ///< lambda from which pairs do not converge
};

/// The lowest pairs of K x = lambda M x by a BlockLanczos.
/// @note   Collective.
/// @throws chladni::Error when not all pairs converge in `max_steps`.
EigenPairs block_lanczos(Mat factor, Mat M, const BlockLanczosOptions& options);

}  // namespace chladni::linear
