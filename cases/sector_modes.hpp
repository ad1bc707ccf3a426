#pragma once

#include <vector>

#include "cases/sector_matrices.hpp"
#include "linear/solver_options.hpp"

/// Natural modes of a body of equal sectors under its supports, harmonic by harmonic.
namespace chladni::cases {

/// A sector, ready for the modes of its harmonics.
struct SupportedSector {
  SectorModel model;
  cyclic::SectorMatrices matrices;
  std::vector<bool> is_held;  ///< [n_dofs]
};

/// @param scene  whose supports hold the sector; no ring of it is an interface
/// @throws chladni::Error for a support that does not turn with the sectors.
SupportedSector supported_sector(const scene::Scene& scene, SectorModel model);

/// Elastic modes of one harmonic, of unit modal mass.
struct ModesOfHarmonic {
  int order;
  Eigen::VectorXd omega;  ///< [k] rad/s, ascending
  int multiplicity;       ///< in the whole body
  double weight;          ///< of the squares of one sector in those of all
  Eigen::MatrixXd x, y;   ///< [6 n_nodes x k] of the nodes of the sector's mesh
};

/// The lowest modes of a harmonic; fewer than n where the harmonic has fewer.
/// @param is_free  the body has all rigid-body motions, which are left out, or none
ModesOfHarmonic elastic_modes(const SupportedSector& sector, int order, int n, bool is_free,
                              const linear::SolverOptions& solver);

/// The modes of this rank's harmonics up to a frequency (rad/s), or the lowest one of all.
/// @note   Collective on all ranks, as all below.
/// @throws chladni::Error on all ranks alike.
std::vector<ModesOfHarmonic> modes_up_to(const SupportedSector& sector, double omega, bool is_free,
                                         const linear::SolverOptions& solver);

/// Lines of numbers of the modes of all ranks, each line as often as its second number says, by its
/// first number, the frequency, and among equal ones by the third, the order of the harmonic.
/// @param own  of this rank, one line after the other
/// @return [n_modes x n_columns]
Eigen::MatrixXd by_frequency(const std::vector<double>& own, Eigen::Index n_columns);

/// The frequencies of all ranks in this order, rad/s.
Eigen::VectorXd frequencies_of(const std::vector<ModesOfHarmonic>& own);

}  // namespace chladni::cases
