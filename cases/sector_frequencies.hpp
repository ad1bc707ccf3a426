#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "cases/sector_modes.hpp"
#include "linear/solver_options.hpp"

namespace chladni::cases {

/// Natural frequencies of a body that repeats about the z axis, from one sector of its mesh, and
/// how far the mesh lets them be off. They are those of the whole body.
class SectorFrequencies {
 public:
  /// Nothing for a body that does not repeat, one that its supports leave some of the rigid-body
  /// motions, and a scene that cannot be reduced from one sector, or where sectors are not looked
  /// for.
  /// @param scene  with the supports under which the frequencies are meant
  /// @param whole  outlives this
  /// @note   Collective on all ranks, as all of this header.
  static std::optional<SectorFrequencies> find(const scene::Scene& scene, const mesh::Mesh& whole);

  /// DOFs of the whole body.
  int n_dofs() const { return n_dofs_; }

  /// The elastic ones up to a frequency (rad/s), or the first.
  /// @return ascending, rad/s, those of a pair twice
  Eigen::VectorXd up_to(double omega, const linear::SolverOptions& solver) const;

  /// Of the elastic ones up to a frequency (rad/s), of the first in any case, as `mesh_errors`;
  /// nothing where a refined mesh does not repeat: the digits of a mesh file may not suffice.
  std::optional<MeshErrors> errors_up_to(double omega, const linear::SolverOptions& solver) const;

 private:
  SectorFrequencies(scene::Scene scene, const mesh::Mesh& whole, int count)
      : scene_(std::move(scene)), whole_(&whole), count_(count)
  {}

  scene::Scene scene_;  ///< with no other interface nodes than those on the axis
  const mesh::Mesh* whole_;
  int count_;
  std::vector<std::string> interface_ = {};  ///< of the scene
  std::shared_ptr<const SupportedSector> sector_ = {};
  int n_dofs_ = 0;
  int n_rigid_ = 0;  ///< 0 or 6
};

}  // namespace chladni::cases
