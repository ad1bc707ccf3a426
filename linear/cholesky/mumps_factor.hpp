#pragma once

#include <dmumps_c.h>
#include <petsc/private/petscimpl.h>

#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "linear/cholesky/cholesky_factor.hpp"

namespace chladni::linear {

/// The destinations of the rows of a solution that MUMPS leaves distributed.
struct RowExchange {
  std::vector<int> send_rows;  ///< rows of MUMPS' solution, ordered by owner
  std::vector<int> send_counts, receive_counts;
  std::vector<int> receive_rows;  ///< own rows, ordered by sender
};

/// Plans the exchange of rows.
/// @param rows        [n] global rows, from 1, of the solution that MUMPS left on this rank
/// @param first_rows  [n_ranks + 1] first row of each rank
/// @note   Collective on `comm`.
RowExchange plan_exchange(const std::vector<int>& rows, const std::vector<PetscInt>& first_rows,
                          MPI_Comm comm);

/// Moves columns that MUMPS left distributed to the ranks that own their rows.
/// @note   Collective on `comm`.
void exchange_rows(const RowExchange& plan, const std::vector<double>& from,
                   PetscInt from_leading_dimension, LocalColumns to, MPI_Comm comm);

/// Identifies a matrix and the state of its values.
struct MatrixState {
  PetscObjectId id = 0;
  PetscObjectState state = 0;
  bool operator==(const MatrixState&) const = default;
};

inline MatrixState state_of(Mat A)
{
  MatrixState now;
  petsc::check(PetscObjectGetId(reinterpret_cast<PetscObject>(A), &now.id));
  petsc::check(PetscObjectStateGet(reinterpret_cast<PetscObject>(A), &now.state));
  return now;
}

/// What is known about the definiteness of a matrix.
enum class Definiteness { positive, unknown };

/// Cholesky factor by MUMPS through its C interface, with nested dissection by METIS and
/// distributed matrix, right-hand sides and solutions. Debian's MUMPS lacks METIS, and PETSc's
/// gathering of several right-hand sides on several ranks costs more than the solve.
class MumpsFactor : public CholeskyFactor {
 public:
  /// @param definiteness  MUMPS pivots if it is unknown
  MumpsFactor(MPI_Comm comm, Definiteness definiteness);
  ~MumpsFactor() override;

  /// Sets ICNTL(index), counted from 1 as in MUMPS' manual.
  void set_control(int index, int value) { mumps_.icntl[index - 1] = value; }
  void set_control(int index, double value) { mumps_.cntl[index - 1] = value; }
  int control(int index) const { return mumps_.icntl[index - 1]; }
  double real_control(int index) const { return mumps_.cntl[index - 1]; }
  /// INFOG(index), counted from 1.
  int info(int index) const { return mumps_.infog[index - 1]; }
  double real_info(int index) const { return mumps_.rinfog[index - 1]; }
  void analyze(Mat A) override;
  void factorize(Mat A) override;
  MatFactorError error() const override;
  PetscInt n_negative_pivots() const override;
  bool is_reliable() const override;
  void solve(LocalColumns X) override;
  void solve(const SparseColumns& B, LocalColumns X) override;
  PetscInt columns_at_a_time() const override;
  Memory forecast() const override;
  FactorSize size() const override;
  std::string description() const override;

 private:
  void call(int job);
  void call_solve();
  bool lacks_room() const;
  void load_entries(Mat A);
  PetscInt most_columns(PetscInt leading_dimension) const;
  void solve_at_once(LocalColumns X);
  void solve_distributed(LocalColumns X);
  void take_solution(LocalColumns X);

  MPI_Comm comm_ = MPI_COMM_NULL;
  DMUMPS_STRUC_C mumps_{};
  std::vector<PetscInt> first_rows_;  ///< [n_ranks + 1]
  std::vector<int> own_rows_;         ///< rows of this rank, from 1
  std::vector<int> row_indices_, column_indices_;
  std::vector<double> values_;
  MatrixState loaded_;  ///< of the matrix with these entries
  std::vector<double> solution_;
  std::vector<int> solution_rows_;
  RowExchange exchange_;
};

}  // namespace chladni::linear
