#pragma once

#include <dmumps_c.h>

#include <limits>
#include <span>
#include <string>
#include <utility>
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

/// Where the rows of a solution that MUMPS leaves distributed go to.
struct RowExchange {
  std::vector<int> send_rows;  ///< rows of MUMPS' solution, by rank that owns them
  std::vector<int> send_counts, receive_counts;
  std::vector<int> receive_rows;  ///< own rows, by rank that sends them
};

/// Cholesky factor by MUMPS through its C interface: nested dissection by METIS, matrix,
/// right-hand sides and solutions distributed. Debian's MUMPS has no METIS inside, and what PETSc
/// gathers for several right-hand sides on several ranks costs more than the solve.
class MumpsFactor {
 public:
  explicit MumpsFactor(MPI_Comm comm);
  ~MumpsFactor();
  MumpsFactor(const MumpsFactor&) = delete;
  MumpsFactor& operator=(const MumpsFactor&) = delete;

  /// ICNTL(index) = value, from 1 as in MUMPS' manual.
  void set_control(int index, int value) { mumps_.icntl[index - 1] = value; }
  void set_control(int index, double value) { mumps_.cntl[index - 1] = value; }
  int control(int index) const { return mumps_.icntl[index - 1]; }
  /// INFOG(index), from 1.
  int info(int index) const { return mumps_.infog[index - 1]; }
  double real_info(int index) const { return mumps_.rinfog[index - 1]; }
  /// Ordering and symbolic factorisation.
  void analyze(Mat A);
  /// MiB that the ranks of the fullest machine need together for the factorisation, by the
  /// analysis.
  /// @note   Collective.
  double forecast_MiB() const;
  /// What the factor may take on one machine; infinite at first.
  double budget_MiB = std::numeric_limits<double>::infinity();
  /// Numerical factorisation; info(1) < 0 tells of failure.
  void factorize(Mat A);
  /// X <- A^-1 X in place.
  void solve(LocalColumns X);
  /// X <- A^-1 B; the forward elimination uses the zeros of B.
  void solve(const SparseColumns& B, LocalColumns X);

 private:
  void call(int job);
  void call_solve();
  void load_entries(Mat A);
  void solve_distributed(LocalColumns X);
  void take_solution(LocalColumns X);

  MPI_Comm comm_ = MPI_COMM_NULL;
  DMUMPS_STRUC_C mumps_{};
  std::vector<PetscInt> first_rows_;  ///< [n_ranks + 1]
  std::vector<int> own_rows_;         ///< from 1
  std::vector<int> row_indices_, column_indices_;
  std::vector<double> values_;
  std::vector<double> solution_;
  std::vector<int> solution_rows_;
  RowExchange exchange_;
};

}  // namespace chladni::reduce
