#pragma once

#include <Eigen/Core>

#include "cases/fe_solution.hpp"
#include "linear/solver_options.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cases {

/// Natural frequencies of a supported model, and how far its mesh lets them be from those of the
/// continuum: of the plate theory, on the geometry of its elements.
struct MeshErrors {
  Eigen::VectorXd omega;   ///< [k] of the elastic modes, ascending; rad/s
  Eigen::VectorXd errors;  ///< [k] estimated relative errors of omega, without sign
  /// [6 x k] of the radial, circumferential and axial displacements of the interface nodes about
  /// the z axis, and of their rotations about these directions: of root mean squares in a mode of
  /// unit modal mass; 0 where the mode does not move them
  Eigen::MatrixXd shape_errors;
  Eigen::VectorXd finer;  ///< [k] the frequencies of the finer model, of the same modes; rad/s

  double largest() const { return errors.size() > 0 ? errors.maxCoeff() : 0.0; }
};

/// From the frequencies of the same elements at half the size; of a large model of one order more,
/// and of one order less, whose differences tell what the finer one still lacks. Each other model
/// costs one factor and one solution for all modes.
/// @param modes  of the model, as many as get an estimate
/// @note   Collective.
MeshErrors mesh_errors(const scene::Scene& scene, const SupportedModel& model,
                       const reduce::NaturalModes& modes, const linear::SolverOptions& solver = {});

}  // namespace chladni::cases
