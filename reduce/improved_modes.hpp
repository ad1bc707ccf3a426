#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "reduce/supported_solutions.hpp"

namespace chladni::reduce {

/// Shapes that are close to the lowest modes of a model.
struct ShapesNearModes {
  int n_shapes;
  /// [n_dofs x n_shapes], of global DOFs; asked by each rank for those that it owns
  std::function<Eigen::MatrixXd(const std::vector<PetscInt>& dofs)> rows;
};

/// Ritz pairs of the space into which one inverse iteration takes a block of shapes.
struct ImprovedModes {
  Eigen::VectorXd lambda;  ///< [k] ascending, rad^2/s^2
  Eigen::MatrixXd shares;  ///< [k x k] squared share of shape i in mode j
  petsc::Matrix X;         ///< [free DOFs x k] dense, X^T M X = I
};

/// The modes of a discretisation from those of another: what one inverse iteration leaves of the
/// difference is of the order of its square in lambda.
/// @param mu    rad^2/s^2; K + mu M is positive definite: 0, or where rigid-body motions are left
///              about the first elastic eigenvalue
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when K + mu M of the free DOFs is not positive definite.
ImprovedModes improved_modes(Mat K, Mat M, const FreeDofs& free, const ShapesNearModes& shapes,
                             double mu, const linear::SolverOptions& options = {});

}  // namespace chladni::reduce
