#pragma once

#include <memory>

#include "linear/cholesky/cholesky_factor.hpp"

namespace chladni::linear {

/// A factor without pivoting as long as the matrix is definite, and otherwise one by MUMPS with
/// pivoting. If pivots vanish or change sign, elimination in a given order amplifies round-off
/// without limit.
class PivotingFallback : public CholeskyFactor {
 public:
  PivotingFallback(std::unique_ptr<CholeskyFactor> definite, MPI_Comm comm);

  void analyze(Mat A) override;
  void factorize(Mat A) override;
  MatFactorError error() const override { return error_; }
  PetscInt n_negative_pivots() const override { return active().n_negative_pivots(); }
  bool is_reliable() const override { return active().is_reliable(); }
  void solve(LocalColumns X) override { active().solve(X); }
  void solve(const SparseColumns& B, LocalColumns X) override { active().solve(B, X); }
  PetscInt columns_at_a_time() const override { return active().columns_at_a_time(); }
  Memory forecast() const override { return active().forecast(); }
  FactorSize size() const override { return active().size(); }
  std::string description() const override;
  const CholeskyFactor& active() const override { return pivoting_ ? *pivoting_ : *definite_; }
  using CholeskyFactor::active;

 private:
  std::unique_ptr<CholeskyFactor> definite_;
  std::unique_ptr<CholeskyFactor> pivoting_;  ///< set while the matrix is indefinite
  MPI_Comm comm_;                             ///< of the matrix
  MatFactorError error_ = MAT_FACTOR_NOERROR;
};

}  // namespace chladni::linear
