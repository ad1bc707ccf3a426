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
