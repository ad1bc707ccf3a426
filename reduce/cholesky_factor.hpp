#pragma once

#include <limits>
#include <string>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::reduce {

/// Sparse right-hand sides by columns; on rank 0 all of them, on the other ranks the number only.
struct SparseColumns {
  int n_columns = 0;
  std::vector<int> starts;     ///< [n_columns + 1] from 0
  std::vector<int> rows;       ///< [non-zeros] from 0
  std::vector<double> values;  ///< [non-zeros]
};

/// Columns of the rows of this rank, one after the other.
struct LocalColumns {
  double* values;
  PetscInt leading_dimension;
  PetscInt n_columns;
};

struct FactorSize {
  double operations;  ///< floating-point, of the factorisation
  double entries;     ///< of the triangle
};

/// A Cholesky factor of a sparse positive definite matrix that is distributed by rows, as are
/// right-hand sides and solutions. All calls are collective.
class CholeskyFactor {
 public:
  CholeskyFactor() = default;
  virtual ~CholeskyFactor() = default;
  CholeskyFactor(const CholeskyFactor&) = delete;
  CholeskyFactor& operator=(const CholeskyFactor&) = delete;

  /// Ordering and symbolic factorisation.
  virtual void analyze(Mat A) = 0;
  /// Numerical factorisation.
  virtual void factorize(Mat A) = 0;
  /// Of the last of the two.
  virtual MatFactorError error() const = 0;
  virtual PetscInt n_negative_pivots() const = 0;
  /// X <- A^-1 X in place.
  virtual void solve(LocalColumns X) = 0;
  /// X <- A^-1 B; the forward elimination uses the zeros of B.
  virtual void solve(const SparseColumns& B, LocalColumns X) = 0;
  /// Of sparse right-hand sides, as many as it likes.
  virtual PetscInt columns_at_a_time() const = 0;
  /// MiB that the ranks of the fullest machine need together for the factorisation, by the
  /// analysis.
  virtual double forecast_MiB() const = 0;
  virtual FactorSize size() const = 0;
  /// For -cms_view: one line.
  virtual std::string description() const = 0;

  /// What the factor may take on one machine.
  double budget_MiB = std::numeric_limits<double>::infinity();
};

/// The sum over the ranks of one machine, of the machine where it is largest.
double fullest_machine(double own, MPI_Comm comm);

}  // namespace chladni::reduce
