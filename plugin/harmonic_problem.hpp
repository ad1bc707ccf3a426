#pragma once

#include <vector>

#include "cyclic/harmonic_operators.hpp"
#include "plugin/check_operators.hpp"

/// The step from the matrices of a sector to those of one of its harmonics, which are then reduced.
namespace chladni::plugin {

/// Checked operators, as AIJ.
struct Operators {
  petsc::Matrix K, M;
  VelocityForces velocity;
};

/// The arguments of CMSSetCyclic.
struct Sectors {
  int count;
  petsc::IndexSet low, high;
  Eigen::MatrixXd R;
};

/// Masters of a harmonic in the order of its reduced rows; all vectors have one length.
struct HarmonicMasters {
  std::vector<PetscInt> coordinates;  ///< rows of the harmonic's matrices
  std::vector<PetscInt> rows;         ///< rows of the sector's matrices
  std::vector<PetscInt> phases;       ///< 0 for x, 1 for y
  std::vector<PetscInt> places;       ///< places in the interface
};

/// The matrices of a harmonic and its masters.
struct HarmonicProblem {
  cyclic::SectorHarmonic harmonic;
  Operators operators;
  HarmonicMasters masters = {};  ///< filled by CMSSetUp
};

/// The indices of all ranks, in the order of the ranks, on every rank.
/// @note   Collective.
std::vector<PetscInt> all_indices(IS set);

/// Makes the matrices of one harmonic.
/// @param order   number of the harmonic, 0 to count / 2
/// @param sector  operators of the sector
/// @note   Collective.
/// @throws chladni::Error on all ranks when the edges do not match, or there is no such harmonic.
HarmonicProblem harmonic_problem(const Sectors& sectors, PetscInt order, const Operators& sector);

/// The masters of a harmonic: x of all masters, then y. Those that the harmonic does not move are
/// left out.
/// @param masters  rows of the sector in the order of the interface
/// @throws chladni::Error when a master is in the high edge and so follows another row, or is of a
///         shared node of whose rows that move together others are missing.
HarmonicMasters harmonic_masters(const cyclic::SectorCoordinates& coordinates,
                                 const std::vector<PetscInt>& masters);

}  // namespace chladni::plugin
