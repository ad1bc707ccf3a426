#pragma once

#include <functional>

#include "reduce/block_basis.hpp"
#include "reduce/symmetric_eigen.hpp"

namespace chladni::reduce {

/// Y <- Op Q for an operator that is self-adjoint in the inner product of M; M Q is at hand.
using BlockOperator = std::function<void(Mat Q, Mat MQ, Mat Y)>;

/// The iteration of block Lanczos with full reorthogonalisation and thick restart, one step at a
/// time, for any operator self-adjoint in M: Op V = V T + Q R E_last^T with V^T M V = I. Ritz
/// values come in the order that the caller prefers. How long to go on is the caller's decision.
/// Source: as `block_lanczos`.
class BlockIteration {
 public:
  /// True where the Ritz value a is to come before b.
  using Order = std::function<bool(double a, double b)>;

  /// @param capacity  most basis vectors, the newest block included
  BlockIteration(Mat M, PetscInt block_size, PetscInt capacity);

  /// Room for a larger basis.
  void reserve(PetscInt capacity) { basis_.reserve(capacity); }
  /// Takes a deterministic start block once through the operator.
  /// @throws chladni::Error when the operator or M maps it to zero.
  void start(const BlockOperator& op);
  /// Joins the newest block to V, and what the operator makes of it becomes the newest.
  void step(const BlockOperator& op);
  /// Solves the projected problem; fills `theta`.
  void order_ritz_values(const Order& before);
  /// Keeps the first `n` Ritz vectors and the newest block.
  void restart(PetscInt n);

  PetscInt n_vectors() const { return n_old_; }
  bool is_full() const { return basis_.n_columns() + block_size_ > basis_.capacity(); }
  /// The subspace is invariant: its Ritz pairs are exact and it cannot grow.
  bool is_exhausted() const { return R_.n_rows == 0; }
  /// Ritz values in order.
  double theta(PetscInt i) const { return ritz_.values[order_[i]]; }
  /// ||Op x - theta x||_M of Ritz pair i.
  double residual(PetscInt i) const;
  /// Ritz vectors 0 .. n - 1, X^T M X = I; [n_rows x n] dense.
  petsc::Matrix ritz_vectors(PetscInt n) const;
  /// Ritz vectors first .. last - 1 after x <- Op x / theta, which costs nothing: without the null
  /// space of a singular M that round-off brings in. For the largest |theta| only: smaller ones
  /// amplify what errors they have along those.
  petsc::Matrix purified_vectors(PetscInt first, PetscInt last) const;

 private:
  /// Coefficients of Ritz vectors first .. last - 1 in (V, Q).
  SmallMatrix ritz_coefficients(PetscInt first, PetscInt last) const;

  PetscInt block_size_;
  BlockBasis basis_;     ///< V and, behind it, the newest block Q
  PetscInt n_old_ = 0;   ///< columns of V
  SmallMatrix T_{0, 0};  ///< [n_old x n_old]
  SmallMatrix R_{0, 0};  ///< [columns of Q x columns of the last block of V]
  SymmetricEigen ritz_{{}, {0, 0}};
  std::vector<PetscInt> order_;
};

}  // namespace chladni::reduce
