#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "reduce/supported_solutions.hpp"

namespace chladni::reduce {

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
