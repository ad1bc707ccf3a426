#pragma once

#include <memory>
#include <optional>

#include "cases/sector_frequencies.hpp"

namespace chladni::cases {

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

}  // namespace chladni::cases
