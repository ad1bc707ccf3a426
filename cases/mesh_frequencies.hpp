#pragma once

#include <memory>
#include <optional>

#include "cases/sector_frequencies.hpp"

namespace chladni::cases {

/// Natural frequencies on a mesh of the scene, and how far the mesh lets them be off: of one sector
/// of a body that repeats, else of the whole.
class MeshFrequencies {
 public:
  /// @param scene  with the supports under which the frequencies are meant
  /// @param mesh   of the whole body
  /// @note   Collective, as all of this.
  /// @throws chladni::Error on all ranks alike, as assemble_supported.
  MeshFrequencies(const scene::Scene& scene, mesh::Mesh mesh);

  /// Of the whole body.
  int n_dofs() const;
  /// The lowest elastic ones, as many as are known of another mesh of the body.
  /// @param known  [n] ascending, rad/s, as those returned
  /// @throws chladni::Error when the mesh has fewer.
  Eigen::VectorXd like(const Eigen::VectorXd& known, const linear::SolverOptions& solver);
  /// Of the elastic ones up to a frequency (rad/s), of the first in any case.
  MeshErrors errors_up_to(double omega, const linear::SolverOptions& solver);

 private:
  const SupportedModel& whole();

  scene::Scene scene_;
  std::unique_ptr<const mesh::Mesh> mesh_;  ///< at one place, where the sector finds it
  std::optional<SectorFrequencies> sector_;
  std::optional<SupportedModel> whole_ = {};  ///< where it was needed
};

}  // namespace chladni::cases
