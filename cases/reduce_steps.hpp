#pragma once

#include <vector>

#include "cases/attachments.hpp"
#include "cases/phases.hpp"
#include "linear/kernels/parted_form.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/assemble.hpp"
#include "reduce/reduction.hpp"
#include "scene/scene.hpp"

/// The data that the steps of `reduce_scene` pass on.
namespace chladni::cases {

struct FeModel {
  mesh::Mesh mesh;
  plate::System system;
  Attachments attachments;
};

/// The reduction of an FE model, and the system that is written.
struct SceneReduction {
  reduce::FactoredBody body;
  reduce::Reduction reduction;
  std::vector<int> places;           ///< of the file's coordinates in the model
  mbs_export::ReducedSystem system;  ///< in the order of the file
  int n_modes;                       ///< fixed-interface or free-interface modes
  double modes_residual;             ///< largest residual of the fixed-interface modes
};

/// The sections, masses and springs of the scene's body; refers to the scene.
plate::Structure structure_of(const scene::Scene& scene);

/// A matrix of the FE model in the coordinates of the file.
/// @note   Collective.
Eigen::MatrixXd projected(const SceneReduction& reduced, Mat A,
                          linear::FormSymmetry symmetry = linear::FormSymmetry::none);

}  // namespace chladni::cases
