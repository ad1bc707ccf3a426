#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/petsc.hpp"

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
