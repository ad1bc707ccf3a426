#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "cases/phases.hpp"
#include "cases/sector_frequencies.hpp"
#include "linear/solver_options.hpp"
#include "mesh/mesh_options.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// A scene with a fixed mesh, and the errors of the frequencies on it.
struct MeshChoice {
  scene::Scene scene;
  /// of the body under its supports, if they were estimated
  std::optional<MeshErrors> errors;
};

/// The supports of the body of a scene (BodyOptions::fixed) as supports of its FE model.
std::vector<plate::Support> supports_of(const scene::Scene& scene);

/// With `accuracy`, the cheapest mesh found that keeps it: coarse meshes of all available orders,
/// with and without rows of elements at the edges, show which size each would need, and the best
/// one is refined until its estimated error is small enough. Of solids, the scene's own mesh if it
/// keeps the accuracy. Without `accuracy`, the scene's own mesh, with the errors of its frequencies
/// if the scene asks for them.
/// @param supports  under which the frequencies are meant
/// @note   Collective.
/// @throws chladni::Error when no mesh keeps the accuracy, with the error of the best one.
MeshChoice chosen_mesh(const scene::Scene& scene, const std::vector<plate::Support>& supports,
                       const linear::SolverOptions& solver, Phases& phases);

/// Natural frequencies on a mesh of the scene and their errors by the mesh, computed from one
/// sector of a periodic body, else from the whole.
class MeshFrequencies {
 public:
  /// @param scene  with the supports under which the frequencies are meant
  /// @param mesh   of the whole body
  /// @note   Collective, as are all members.
  /// @throws chladni::Error on all ranks alike, as `assemble_supported`.
  MeshFrequencies(const scene::Scene& scene, mesh::Mesh mesh);

  /// Number of DOFs of the whole body.
  int n_dofs() const;
  /// The lowest elastic frequencies, as many as are known from another mesh of the body.
  /// @param known  [n] ascending, rad/s
  /// @return [n] ascending, rad/s
  /// @throws chladni::Error when the mesh has fewer.
  Eigen::VectorXd like(const Eigen::VectorXd& known, const linear::SolverOptions& solver);
  /// The errors of the elastic frequencies up to omega [rad/s], or of the first one.
  MeshErrors errors_up_to(double omega, const linear::SolverOptions& solver);

 private:
  const SupportedModel& whole();

  scene::Scene scene_;
  std::unique_ptr<const mesh::Mesh> mesh_;  ///< at a fixed address, to which the sector refers
  std::optional<SectorFrequencies> sector_;
  std::optional<SupportedModel> whole_ = {};  ///< assembled when it is needed
};

/// Sizes of elements at places, and how many elements of that size fill the body.
struct LocalSizes {
  std::vector<mesh::SizeAt> sizes;
  double n_elements;
};

/// The sizes with which fewest elements have an error: the error of an element is taken to fall
/// with a power of its size.
/// @param shares     of the mesh as it is
/// @param reduction  the wanted error, as a part of that of the mesh
/// @param rate       that power
/// @return sizes between a tenth and 1.4 times of those of the mesh
LocalSizes local_sizes(const std::vector<ErrorShare>& shares, double reduction, double rate);

/// The number of elements of a mesh with these sizes.
double n_elements(const std::vector<ErrorShare>& shares);

}  // namespace chladni::cases
