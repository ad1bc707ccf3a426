#pragma once

#include <vector>

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::reduce {

/// The DOFs of a system that supports leave free; each rank holds those that it owns, ascending.
struct FreeDofs {
  petsc::IndexSet indices;  ///< rows of K
};

/// All rows of `K` but the held ones.
/// @param held  global DOFs, ascending, each once; may be empty; the same list on every rank.
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when nothing is left free.
FreeDofs free_dofs(Mat K, const std::vector<int>& held);

/// The first n columns of X, of the free DOFs, in the rows of all DOFs; zero at the held ones.
/// @note   Collective.
petsc::Matrix of_all_dofs(Mat X, const FreeDofs& free, Mat K, PetscInt n);

/// K u = f with u = 0 at the held DOFs.
struct StaticSolution {
  petsc::Vector u;         ///< of all DOFs
  petsc::Vector reaction;  ///< K u - f, zero up to round-off where the DOFs are free
};

/// One factorisation by Cholesky, one solution.
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when K of the free DOFs is not positive definite.
StaticSolution static_solution(Mat K, Vec f, const FreeDofs& free,
                               const linear::SolverOptions& options = {});

/// U of K U = F with U = 0 at the held DOFs, for several loads: one factorisation by Cholesky.
/// @param F  [n_DOFs x n] dense
/// @return [n_DOFs x n] dense
/// @note   Collective on the communicator of `K`.
/// @throws linear::FreeMotion when K of the free DOFs is not positive definite.
petsc::Matrix static_solutions(Mat K, Mat F, const FreeDofs& free,
                               const linear::SolverOptions& options = {});

/// K x = lambda M x on the free DOFs, X^T M X = I, lambda ascending.
struct NaturalModes {
  std::vector<double> lambda;  ///< [n] rad^2/s^2; rigid-body motions first, with round-off's lambda
  petsc::Matrix X;             ///< [n_DOFs x n] dense, zero at the held DOFs; 1/sqrt(kg)
};

struct NaturalModesOptions {
  int n_modes;      ///< as many as are wanted, rigid-body motions included
  int n_rigid = 0;  ///< rigid-body motions among them
  linear::SolverOptions solver = {};
};

/// The lowest natural modes by block Lanczos. A free body is factorised as K + mu M: mu > 0 is near
/// its lowest elastic eigenvalue, which a few steps with a first guess of mu tell; another
/// factorisation follows where that guess was far off.
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when more modes are asked than there are or they do not converge.
NaturalModes natural_modes(Mat K, Mat M, const FreeDofs& free, const NaturalModesOptions& options);

}  // namespace chladni::reduce
