#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cases/fe_solution.hpp"
#include "linear/solver_options.hpp"
#include "mbs_export/certificate.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cases {

/// The share of an element of the mesh in the errors.
struct ErrorShare {
  std::array<double, 3> x;  ///< m, its middle
  double area;              ///< m^2
  double size;              ///< m, of its sides
  double share;  ///< of the largest error; those of other modes count in proportion to theirs
};

/// Natural frequencies of a supported model, and their estimated errors by the mesh: the distance
/// from those of the plate theory on the geometry of the elements.
struct MeshErrors {
  Eigen::VectorXd omega;   ///< [k] of the elastic modes, ascending; rad/s
  Eigen::VectorXd errors;  ///< [k] estimated relative errors of omega, without sign
  /// [6 x k] relative errors of the radial, circumferential and axial displacements of the
  /// interface nodes about the z axis, and of their rotations about these directions, as root mean
  /// squares in a mode of unit modal mass; 0 where the mode does not move them.
  Eigen::MatrixXd shape_errors;
  Eigen::VectorXd finer;  ///< [k] rad/s, the same modes in the finer model
  /// Of the surface elements, where the mesh takes sizes at places; else empty.
  std::vector<ErrorShare> shares = {};

  double largest() const { return errors.size() > 0 ? errors.maxCoeff() : 0.0; }
};

/// Estimates the errors from the frequencies of the same elements at half the size. For a large
/// model it uses elements of one order more and of one order less instead; their differences show
/// what the finer one still lacks. Each other model costs one factor and one solution for all
/// modes.
/// @param modes  of the model; each gets an estimate
/// @note   Collective.
MeshErrors mesh_errors(const scene::Scene& scene, const SupportedModel& model,
                       const reduce::NaturalModes& modes, const linear::SolverOptions& solver = {});

/// The growth of own compliances at the interface sets of three or more nodes, by elements of half
/// the size or, for a large model, of one order more. It costs two factors. Empty for a model with
/// rigid-body motions, and for one that is too large for these.
/// @param scene  with the supports of the body
/// @note   Collective.
mbs_export::OwnCompliances mesh_compliances(const scene::Scene& scene,
                                            const linear::SolverOptions& solver);

}  // namespace chladni::cases
