#pragma once

#include <vector>

#include "cyclic/harmonic_operators.hpp"
#include "plugin/check_operators.hpp"

/// What stands between the matrices of a sector and the reduction: one of its harmonics.
namespace chladni::plugin {

/// What has been checked, as AIJ.
struct Operators {
  petsc::Matrix K, M;
  VelocityForces velocity;
};

/// What CMSSetCyclic says.
struct Sectors {
  int count;
  petsc::IndexSet low, high;
  Eigen::MatrixXd R;
};

/// Masters of a harmonic in the order of its reduced rows; vectors of one length.
struct HarmonicMasters {
  std::vector<PetscInt> coordinates;
  std::vector<PetscInt> rows;    ///< of the sector
  std::vector<PetscInt> phases;  ///< 0 of x, 1 of y
  std::vector<PetscInt> places;  ///< in the interface
};

/// The matrices of a harmonic, which are reduced as any others.
struct HarmonicProblem {
  cyclic::SectorHarmonic harmonic;
  Operators operators;
  HarmonicMasters masters = {};  ///< from CMSSetUp on
};

/// The indices of all ranks, one rank after the other, on every rank.
/// @note   Collective.
std::vector<PetscInt> all_indices(IS set);

/// @param order  the harmonic
/// @note   Collective.
/// @throws chladni::Error on all ranks when the edges do not match, or there is no such harmonic.
HarmonicProblem harmonic_problem(const Sectors& sectors, PetscInt order, const Operators& sector);

/// @param masters  rows of the sector in the order of the interface
/// @throws chladni::Error when one of them follows another row, or none moves.
HarmonicMasters harmonic_masters(const cyclic::SectorCoordinates& coordinates,
                                 const std::vector<PetscInt>& masters);

}  // namespace chladni::plugin
