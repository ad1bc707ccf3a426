#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "reduce/cyclic/harmonic_coordinates.hpp"

namespace chladni::plugin {

/// Checks a symmetric operator and returns it as AIJ with ascending rows: a reference if it is that
/// already, else a converted copy.
/// @param like  the matrix whose rows, columns and distribution A must have
/// @param name  of A, for messages
/// @note   Collective.
/// @throws chladni::Error on all ranks when A has another layout than `like`, is not assembled, is
///         not symmetric, has a value that is not finite, a negative diagonal value, or A_ij^2 >
///         A_ii A_jj.
petsc::Matrix checked_operator(Mat A, Mat like, const char* name);

/// The matrix C of forces by velocities: damping is symmetric, gyroscopic forces are
/// skew-symmetric.
struct VelocityForces {
  petsc::Matrix C;
  bool is_symmetric;
};

/// Checks C, which may have any symmetry, and returns it as AIJ.
/// @param like  the matrix whose rows, columns and distribution C must have
/// @note   Collective.
/// @throws chladni::Error on all ranks when C has another layout, is not assembled, or has a value
///         that is not finite or a negative diagonal value.
VelocityForces checked_velocity_forces(Mat C, Mat like);

/// Returns the name of a row for messages, in the user's terms: "row 17 of K".
using NameOfRow = std::function<std::string(PetscInt)>;

/// Checks that every slave has stiffness and every master stiffness or mass.
/// @param masters      global rows, ascending, the same on every rank
/// @param name_of_row  needed where rows are not those of the user's K
/// @note   Collective.
/// @throws chladni::Error on all ranks, naming a row without them.
void refuse_empty_rows(Mat K, Mat M, const std::vector<PetscInt>& masters,
                       const NameOfRow& name_of_row = {});

}  // namespace chladni::plugin

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
