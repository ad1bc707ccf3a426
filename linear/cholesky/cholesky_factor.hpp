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

/// Sparse right-hand sides by columns: all of them on rank 0; only their number on the other ranks.
struct SparseColumns {
  int n_columns = 0;
  std::vector<int> starts;     ///< [n_columns + 1] from 0
  std::vector<int> rows;       ///< [non-zeros] from 0
  std::vector<double> values;  ///< [non-zeros]
};

/// Columns of a dense matrix in the rows of this rank, stored one after the other.
struct LocalColumns {
  double* values;
  PetscInt leading_dimension;
  PetscInt n_columns;
};

/// The size of a factor.
struct FactorSize {
  double operations;  ///< floating-point operations of the factorisation
  double entries;     ///< of the triangle
  /// Those of the rank that has most, with stored zeros and work that ranks repeat; 0 if the
  /// package does not tell.
  double operations_of_rank = 0.0, entries_of_rank = 0.0;
};

/// The memory available for a factor, and the memory needed beside it.
struct MemoryBudget {
  /// Available on this machine, for all its ranks.
  double machine_MiB = std::numeric_limits<double>::infinity();
  /// What this rank takes later, after the factorisation, while the factor stays.
  double beside_MiB = 0.0;
  SecondFactor second = {};
};

/// A factor L D L^T of a sparse symmetric matrix, positive definite unless stated otherwise.
/// Factor, right-hand sides and solutions are distributed by rows. All calls are collective.
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
  /// The error of the last `analyze` or `factorize`.
  virtual MatFactorError error() const = 0;
  virtual PetscInt n_negative_pivots() const = 0;
  /// False where pivots vanished or changed sign and there was no pivoting: solutions may then be
  /// wrong in any digit.
  virtual bool is_reliable() const = 0;
  /// X <- A^-1 X in place.
  virtual void solve(LocalColumns X) = 0;
  /// X <- A^-1 B; the forward elimination uses the zeros of B.
  virtual void solve(const SparseColumns& B, LocalColumns X) = 0;
  /// The number of sparse right-hand sides that are solved for at once.
  virtual PetscInt columns_at_a_time() const = 0;
  /// MiB that this rank needs in addition to what it has, by the analysis: during the
  /// factorisation, and later for the factor and its solutions.
  struct Memory {
    double factorization_MiB, factor_MiB;
    double entries_MiB;  ///< of the factor alone
  };
  virtual Memory forecast() const = 0;
  virtual FactorSize size() const = 0;
  /// One line for -cms_view.
  virtual std::string description() const = 0;
  /// Frees the entries of the factor; the analysis stays.
  virtual void release() {}
  /// The factor that solves; another one if this one delegates.
  virtual const CholeskyFactor& active() const { return *this; }
  CholeskyFactor& active() { return const_cast<CholeskyFactor&>(std::as_const(*this).active()); }

  /// The need of the machine with the least reserve, with what comes beside the factor, by the
  /// analysis.
  /// @note   Collective.
  MemoryNeed memory_need(MPI_Comm comm) const
  {
    const auto [factorization_MiB, factor_MiB, entries_MiB] = forecast();
    const double with_second_MiB = budget.second.beside_MiB + budget.second.entries * entries_MiB;
    const double later_MiB = factor_MiB + std::max(budget.beside_MiB, with_second_MiB);
    return tightest_machine(std::max(factorization_MiB, later_MiB), budget.machine_MiB, comm);
  }

  MemoryBudget budget;
  /// If true, an indefinite matrix is an error and no reason to pivot.
  bool must_be_definite = false;
};

}  // namespace chladni::linear
