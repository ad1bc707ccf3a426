#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/machine_memory.hpp"
#include "linear/solver_options.hpp"

namespace chladni::linear {

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
  /// Of the rank that has most, with what it repeats; 0 where the package does not tell.
  double operations_of_rank = 0.0, entries_of_rank = 0.0;
};

/// What there is for a factor, and what must go beside it.
struct MemoryBudget {
  /// Of this machine, for all its ranks.
  double machine_MiB = std::numeric_limits<double>::infinity();
  double beside_MiB = 0.0;  ///< what this rank takes later, while the factor alone is there
  SecondFactor second = {};
};

/// A factor L D L^T of a sparse symmetric matrix, positive definite unless it says otherwise, that
/// is distributed by rows, as are right-hand sides and solutions. All calls are collective.
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
  /// False where the pivots vanish or change sign and there was no pivoting: solutions may then be
  /// wrong in any digit.
  virtual bool is_reliable() const = 0;
  /// X <- A^-1 X in place.
  virtual void solve(LocalColumns X) = 0;
  /// X <- A^-1 B; the forward elimination uses the zeros of B.
  virtual void solve(const SparseColumns& B, LocalColumns X) = 0;
  /// Of sparse right-hand sides, as many as it likes.
  virtual PetscInt columns_at_a_time() const = 0;
  /// MiB that this rank needs beyond what it has: for the factorisation, and later for the factor
  /// and its solutions; by the analysis.
  struct Memory {
    double factorization_MiB, factor_MiB;
    double entries_MiB;  ///< of the factor alone
  };
  virtual Memory forecast() const = 0;
  virtual FactorSize size() const = 0;
  /// For -cms_view: one line.
  virtual std::string description() const = 0;
  /// Gives the memory of the numbers back; the analysis stays.
  virtual void release() {}
  /// The factor that solves, where this one has another do it.
  virtual const CholeskyFactor& active() const { return *this; }
  CholeskyFactor& active() { return const_cast<CholeskyFactor&>(std::as_const(*this).active()); }

  /// The tightest machine when this rank takes what comes beside the factor, by the analysis.
  /// @note   Collective.
  MemoryNeed memory_need(MPI_Comm comm) const
  {
    const auto [factorization_MiB, factor_MiB, entries_MiB] = forecast();
    const double with_second_MiB = budget.second.beside_MiB + budget.second.entries * entries_MiB;
    const double later_MiB = factor_MiB + std::max(budget.beside_MiB, with_second_MiB);
    return tightest_machine(std::max(factorization_MiB, later_MiB), budget.machine_MiB, comm);
  }

  MemoryBudget budget;
  /// An indefinite matrix is an error, not a matter for pivoting.
  bool must_be_definite = false;
};

}  // namespace chladni::linear
