#pragma once

#include <Eigen/Core>

#include <functional>
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

/// Approximate shapes of the lowest modes of a model.
struct ShapesNearModes {
  int n_shapes;
  /// Returns the rows [n_dofs x n_shapes] of some global DOFs. Each rank asks for the DOFs that it
  /// owns.
  std::function<Eigen::MatrixXd(const std::vector<PetscInt>& dofs)> rows;
};

/// Ritz pairs of the space that one inverse iteration makes of a block of shapes.
struct ImprovedModes {
  Eigen::VectorXd lambda;  ///< [k] ascending, rad^2/s^2
  Eigen::MatrixXd shares;  ///< [k x k] squared share of shape i in mode j
  petsc::Matrix X;         ///< [free DOFs x k] dense, X^T M X = I
};

/// Computes the modes of one discretisation from the shapes of another by one inverse iteration.
/// The error of lambda that remains is of second order in the error of the shapes.
/// @param mu    rad^2/s^2; K + mu M is positive definite. 0, or about the first elastic eigenvalue
///            where the supports leave rigid-body motions.
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when K + mu M of the free DOFs is not positive definite.
ImprovedModes improved_modes(Mat K, Mat M, const FreeDofs& free, const ShapesNearModes& shapes,
                             double mu, const linear::SolverOptions& options = {});

}  // namespace chladni::reduce
