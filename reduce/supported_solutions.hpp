#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::reduce {

/// The DOFs of a system that supports leave free. Each rank holds those that it owns, ascending.
struct FreeDofs {
  petsc::IndexSet indices;  ///< rows of K
};

/// All rows of `K` that are not held.
/// @param held  global DOFs, ascending, each once; may be empty; the same list on every rank
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when no DOF is left free.
FreeDofs free_dofs(Mat K, const std::vector<int>& held);

/// Expands the first n columns of X from the free DOFs to all DOFs, with zeros at the held ones.
/// @note   Collective.
petsc::Matrix of_all_dofs(Mat X, const FreeDofs& free, Mat K, PetscInt n);

/// The solution of K u = f with u = 0 at the held DOFs.
struct StaticSolution {
  petsc::Vector u;         ///< in all DOFs
  petsc::Vector reaction;  ///< K u - f; zero to round-off at the free DOFs
};

/// Solves one static load case with one Cholesky factorisation.
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when K of the free DOFs is not positive definite.
StaticSolution static_solution(Mat K, Vec f, const FreeDofs& free,
                               const linear::SolverOptions& options = {});

/// Solves K U = F with U = 0 at the held DOFs for several loads, with one Cholesky factorisation.
/// @param F  [n_DOFs x n] dense
/// @return U [n_DOFs x n] dense
/// @note   Collective on the communicator of `K`.
/// @throws linear::FreeMotion when K of the free DOFs is not positive definite.
petsc::Matrix static_solutions(Mat K, Mat F, const FreeDofs& free,
                               const linear::SolverOptions& options = {});

/// The displacement of each DOF by a unit force of its own, u = 0 at the held DOFs.
/// @param loaded  global DOFs, the same on all ranks; 0 is returned for those that are held or < 0
/// @note   Collective on the communicator of `K`.
/// @throws linear::FreeMotion when K of the free DOFs is not positive definite.
Eigen::VectorXd own_compliances(Mat K, const FreeDofs& free, const std::vector<PetscInt>& loaded,
                                const linear::SolverOptions& options = {});

/// Natural modes K x = lambda M x on the free DOFs, X^T M X = I.
struct NaturalModes {
  /// [n] rad^2/s^2, ascending; rigid-body motions come first, with lambda of the size of round-off
  std::vector<double> lambda;
  /// [n_DOFs x n] dense, zero at the held DOFs; 1/sqrt(kg)
  petsc::Matrix X;
};

struct NaturalModesOptions {
  int n_modes;      ///< number of modes, rigid-body motions included
  int n_rigid = 0;  ///< number of rigid-body motions among them
  linear::SolverOptions solver = {};
};

/// The lowest natural modes by block Lanczos. A free body is factored as K + mu M with mu > 0 near
/// its lowest elastic eigenvalue. A few steps with a first guess of mu estimate that eigenvalue;
/// the matrix is factored again if the guess was far off.
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when more modes are asked than exist or they do not converge.
NaturalModes natural_modes(Mat K, Mat M, const FreeDofs& free, const NaturalModesOptions& options);

}  // namespace chladni::reduce
