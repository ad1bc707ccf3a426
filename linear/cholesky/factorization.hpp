#pragma once

#include <string>

#include "common/error.hpp"
#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::linear {

/// Thrown when a part of the body can move while all masters are held.
class FreeMotion : public Error {
 public:
  FreeMotion(const std::string& message, PetscInt most) : Error(message), row(most) {}
  /// Row of the matrix in which the motion is largest; -1 if it is not known.
  PetscInt row;
};

/// The Cholesky factor of a symmetric positive-definite matrix, made once and shared by constraint
/// modes and eigen-solver.
class Factorization {
 public:
  /// @note   Collective on the communicator of `A`.
  /// @throws FreeMotion when `A` is not positive definite to working precision: a motion z has an
  ///         energy of round-off, z^T A z < 32 eps z^T diag(A) z.
  /// @throws chladni::Error, before any arithmetic, when the factor does not fit into the memory
  ///         that is free or that `options` allow.
  /// Options: `-<prefix>pc_factor_mat_solver_type supernodal|mumps-metis|mumps|...`,
  /// `-<prefix>pc_...`, `-<prefix>mat_mumps_...`
  explicit Factorization(Mat A, SolverOptions options = {});

  /// A solver that only applies the factor; for SLEPc's spectral transformation at shift 0.
  KSP solver() const { return solver_; }
  /// The factored matrix, for MatMatSolve and MatMatTransposeSolve.
  Mat factor() const;
  /// The matrix itself.
  Mat matrix() const;
  /// The options of the factorisation, which eigen-solvers with this factor use too.
  const SolverOptions& options() const { return options_; }

 private:
  SolverOptions options_;
  petsc::LinearSolver solver_;
};

/// Factors K_ss.
/// @note   Collective on the communicator of `K_ss`.
/// @throws FreeMotion, chladni::Error as the constructor of Factorization.
Factorization factorize(Mat K_ss, const SolverOptions& options = {});

}  // namespace chladni::linear

/// PETSc's solvers inside the reduction: where their options come from, and which of them are
/// suitable.

namespace chladni::linear {

/// A solver for a system with a factor; its type and operators are to be set.
/// @note   Collective.
petsc::LinearSolver new_solver(MPI_Comm comm, const OptionSource& source);

/// Makes an EPS read the options of `source`.
void set_options_source(EPS eps, const OptionSource& source);

/// Creates the factor of a preconditioner whose type, package and operators are set; nothing is
/// factored yet. MUMPS does not print: its errors come back by MatFactorGetError. It solves for 64
/// columns at a time, which is fastest for the hundreds of right-hand sides of a reduction. The
/// options `-<prefix>mat_mumps_icntl_<i>` and `-<prefix>mat_mumps_cntl_<i>` take precedence;
/// PETSc's interface to MUMPS reads them from the global database in any case.
/// @throws chladni::Error when the options chose another preconditioner than a Cholesky factor.
Mat set_up_factor(PC pc, const OptionSource& source);

/// |A|_1 |A^-1|_1. The second factor is a lower estimate (mostly exact) by Hager's method with at
/// most five solves.
/// @note   Collective.
/// Source: Hager, SIAM J. Sci. Stat. Comput. 5 (1984) 311; Higham, ACM Trans. Math. Softw. 14
/// (1988) 381.
double condition_estimate(const Factorization& A);

}  // namespace chladni::linear
