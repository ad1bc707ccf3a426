#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "cases/sector_modes.hpp"
#include "linear/solver_options.hpp"

namespace chladni::cases {

/// Natural frequencies of a periodic body and their errors by the mesh, computed from one sector of
/// its mesh. They are those of the whole body.
class SectorFrequencies {
 public:
  /// Finds the sector. Absent for a body that is not periodic, for one with some but not all
  /// rigid-body motions left by its supports, for a scene that cannot be reduced from one sector,
  /// and if sectors are not searched for.
  /// @param scene  with the supports under which the frequencies are meant
  /// @param whole  must outlive this object
  /// @note   Collective on all ranks, as are all functions of this header.
  static std::optional<SectorFrequencies> find(const scene::Scene& scene, const mesh::Mesh& whole);

  /// DOFs of the whole body.
  int n_dofs() const { return n_dofs_; }

  /// The elastic frequencies up to omega [rad/s], or the first one.
  /// @return ascending, rad/s, those of a pair twice
  Eigen::VectorXd up_to(double omega, const linear::SolverOptions& solver) const;

  /// The errors of the elastic frequencies up to omega [rad/s], or of the first one, as
  /// `mesh_errors`. Absent if a refined mesh is not periodic, since a mesh file may have too few
  /// digits.
  std::optional<MeshErrors> errors_up_to(double omega, const linear::SolverOptions& solver) const;

 private:
  SectorFrequencies(scene::Scene scene, const mesh::Mesh& whole, int count)
      : scene_(std::move(scene)), whole_(&whole), count_(count)
  {}

  scene::Scene scene_;  ///< its only interface nodes are those on the axis
  const mesh::Mesh* whole_;
  int count_;
  std::vector<std::string> interface_ = {};  ///< interface of the given scene
  std::shared_ptr<const SupportedSector> sector_ = {};
  int n_dofs_ = 0;
  int n_rigid_ = 0;  ///< 0 or 6
};

}  // namespace chladni::cases
