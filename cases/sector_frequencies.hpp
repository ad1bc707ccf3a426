#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "cases/sector_model.hpp"
#include "linear/solver_options.hpp"

/// Natural modes of a body of equal sectors under its supports, harmonic by harmonic.

namespace chladni::cases {

/// A sector with its supports and matrices.
struct SupportedSector {
  SectorModel model;
  cyclic::SectorMatrices matrices;
  std::vector<bool> is_held;  ///< [n_dofs]
};

/// Prepares a sector for the modes of its harmonics.
/// @param scene  its supports hold the sector; none of its rings is an interface
/// @throws chladni::Error for a support that does not turn with the sectors.
SupportedSector supported_sector(const scene::Scene& scene, SectorModel model);

/// Elastic modes of one harmonic, with unit modal mass.
struct ModesOfHarmonic {
  int order;
  Eigen::VectorXd omega = {};  ///< [k] rad/s, ascending
  int multiplicity = 1;        ///< number of modes in the whole body for each one
  /// factor from the squares of one sector to those of all
  double weight = 1.0;
  /// [6 n_nodes x k] of the nodes of the sector's mesh; [0 x 0] without modes
  Eigen::MatrixXd x = {}, y = {};
};

/// The lowest modes of a harmonic; fewer than n if the harmonic has fewer.
/// @param is_free  true: the body has all rigid-body motions, which are left out; false: it has
///                 none
ModesOfHarmonic elastic_modes(const SupportedSector& sector, int order, int n, bool is_free,
                              const linear::SolverOptions& solver);

/// The modes of this rank's harmonics up to omega [rad/s], or the lowest one of all.
/// @note   Collective on all ranks, as are the functions below.
/// @throws chladni::Error on all ranks alike.
std::vector<ModesOfHarmonic> modes_up_to(const SupportedSector& sector, double omega, bool is_free,
                                         const linear::SolverOptions& solver);

/// Collects records of numbers about the modes of all ranks and sorts them by frequency. The first
/// number of a record is the frequency, the second how often the record is repeated, the third the
/// order of the harmonic, by which equal frequencies are sorted.
/// @param own  records of this rank, one after the other
/// @return [n_modes x n_columns]
Eigen::MatrixXd by_frequency(const std::vector<double>& own, Eigen::Index n_columns);

/// The frequencies of all ranks, sorted as by `by_frequency`, rad/s.
Eigen::VectorXd frequencies_of(const std::vector<ModesOfHarmonic>& own);

/// Natural frequencies of a periodic body and their errors by the mesh, computed from one sector of
/// its mesh. They are those of the whole body.
class SectorFrequencies {
 public:
  /// Finds the sector. Absent for a body that is not periodic, for one with some but not all
  /// rigid-body motions left by its supports, for a scene that cannot be reduced from one sector,
  /// and if sectors are not searched for.
  /// @param scene  with the supports under which the frequencies are meant
  /// @param mesh   of the whole body or of one sector; must outlive this object
  /// @note   Collective on all ranks, as are all functions of this header.
  /// @throws chladni::Error for a mesh of one sector, where it would be absent.
  static std::optional<SectorFrequencies> find(const scene::Scene& scene, const mesh::Mesh& mesh);

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
  SectorFrequencies(const scene::Scene& scene, const mesh::Mesh& mesh, int count);

  scene::Scene scene_;      ///< its only interface nodes are those on the axis
  const mesh::Mesh* mesh_;  ///< as it was given
  int count_;
  std::vector<std::string> interface_ = {};  ///< interface of the given scene
  std::shared_ptr<const SupportedSector> sector_ = {};
  int n_dofs_ = 0;
  int n_rigid_ = 0;  ///< 0 or 6
};

}  // namespace chladni::cases
