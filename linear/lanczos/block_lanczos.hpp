#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "common/petsc.hpp"
#include "linear/lanczos/block_iteration.hpp"

namespace chladni::linear {

/// X <- K^-1 B for dense B and X.
using BlockSolve = std::function<void(Mat B, Mat X)>;

struct BlockLanczosOptions {
  PetscInt n_pairs;           ///< wanted
  PetscInt block_size = 8;    ///< a block solve costs 5 to 8 times less per column than single ones
  PetscInt max_subspace = 0;  ///< basis vectors before a restart; 0 = 2.25 n_pairs + 24 blocks
  PetscInt max_steps = 1000;  ///< block solves
  double tolerance = 1e-9;    ///< residual of K^-1 M x = theta x relative to theta, in the M norm
};

/// Eigenpairs of lowest lambda of K x = lambda M x, ascending, X^T M X = I.
struct EigenPairs {
  std::vector<double> lambda;    ///< [k] with k >= n_pairs unless fewer exist
  std::vector<double> residual;  ///< [k] relative, as in `tolerance`
  petsc::Matrix X;               ///< [n x k] dense
  PetscInt n_solves;             ///< columns solved with the factor
};

/// A lambda above all others.
inline constexpr double all_of_them = std::numeric_limits<double>::infinity();

/// Block Lanczos for K^-1 M with full reorthogonalisation in the M inner product and thick restart,
/// which goes on where it stopped when more pairs are asked for.
/// One Krylov space holds no more copies of a multiple eigenvalue than it began with vectors. Where
/// as many were found, it begins anew with random vectors orthogonal to all pairs that converged,
/// until there are fewer (`copies_among`).
/// M may be singular: the Ritz vectors are purified by the step x <- K^-1 M x / theta, which the
/// recurrence holds already. Start vectors depend on the global row only, so that the result does
/// not depend on the number of ranks beyond round-off.
/// Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; thick restart: Wu and
/// Simon, SIAM J. Matrix Anal. Appl. 22 (2000) 602; purification: Nour-Omid, Parlett, Ericsson and
/// Jensen, Math. Comp. 48 (1987) 663.
class BlockLanczos {
 public:
  /// @param factor   Cholesky factor of K, for MatMatSolve; must outlive this.
  /// @param options  all but n_pairs
  BlockLanczos(Mat factor, Mat M, const BlockLanczosOptions& options);
  BlockLanczos(BlockSolve solve, Mat M, const BlockLanczosOptions& options);
  BlockLanczos(const BlockLanczos&) = delete;
  BlockLanczos& operator=(const BlockLanczos&) = delete;

  /// Goes on until the lowest n_pairs, or all where there are fewer, have converged.
  /// @note   Collective.
  /// @throws chladni::Error when they do not in `max_steps`.
  void converge(PetscInt n_pairs);

  /// @throws chladni::Error when pairs below lambda, of which round-off lets too little see, may
  /// not
  ///         be among those that converged.
  void require_resolved(double lambda) const;
  /// The lambda from which on there may be pairs that do not converge, infinity without any; as
  /// far as `converge` has come.
  double unresolved_from() const { return unresolved_from_; }

  /// Pairs that have converged.
  PetscInt n_pairs() const { return n_converged_; }
  /// Columns solved with the factor so far.
  PetscInt n_solves() const { return n_solves_; }
  double lambda(PetscInt i) const { return 1.0 / iteration_.theta(i); }
  /// Relative, as in BlockLanczosOptions::tolerance.
  double residual(PetscInt i) const { return iteration_.residual(i) / iteration_.theta(i); }
  /// X of pairs first .. last - 1, orthonormal in M.
  /// @note   Collective.
  petsc::Matrix vectors(PetscInt first, PetscInt last) const
  {
    return iteration_.purified_vectors(first, last, op_);
  }

 private:
  bool has_converged(PetscInt n_pairs);
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
  PetscInt next_look_ = 0;      ///< number of basis vectors
  PetscInt n_kept_before_ = 0;  ///< by the last sequence that began from an exhausted basis
  double unresolved_from_ = all_of_them;  ///< lambda from which pairs do not converge
};

/// The lowest pairs by a BlockLanczos.
/// @note   Collective.
/// @throws chladni::Error when not all pairs converge in `max_steps`.
EigenPairs block_lanczos(Mat factor, Mat M, const BlockLanczosOptions& options);

}  // namespace chladni::linear
