#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::plugin {

/// An operator as AIJ: a reference where it is AIJ, else a converted copy.
/// @note   Collective.
/// @throws chladni::Error on all ranks when A has not the rows and columns of `like`, is not
/// assembled, has a value that is not finite or a negative diagonal value, or is not symmetric.
petsc::Matrix checked_operator(Mat A, Mat like, const char* name);

/// C may be any matrix: damping is symmetric, gyroscopic forces are skew-symmetric.
struct VelocityForces {
  petsc::Matrix C;
  bool is_symmetric;
};

/// The same for C, whatever its symmetry.
/// @note   Collective.
VelocityForces checked_velocity_forces(Mat C, Mat like);

/// "row 17 of K", as the user knows it.
using NameOfRow = std::function<std::string(PetscInt)>;

/// @param masters  global rows, ascending, the same on every rank
/// @param name_of_row  where rows are not those of the user's K
/// @note   Collective.
/// @throws chladni::Error on all ranks, naming the row, when a slave has no stiffness at all or a
/// master has neither stiffness nor mass.
void refuse_empty_rows(Mat K, Mat M, const std::vector<PetscInt>& masters,
                       const NameOfRow& name_of_row = {});

}  // namespace chladni::plugin
