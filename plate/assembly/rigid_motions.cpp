#include "plate/assembly/rigid_motions.hpp"

#include <Eigen/Geometry>
#include <cassert>

namespace chladni::plate {

using Eigen::Vector3d;

Vector3d centre_of_nodes(const DofMap& dofs)
{
  Vector3d sum = Vector3d::Zero();
  for (int node = 0; node < dofs.n_nodes(); ++node) sum += dofs.position(node);
  return sum / static_cast<double>(dofs.n_nodes());
}

petsc::Matrix rigid_motions(const System& system)
{
  const DofMap& dofs = system.dofs;
  assert(!dofs.has_combined_motions());
  petsc::Matrix R;
  PetscInt n_local = 0;
  petsc::check(MatGetLocalSize(system.K, &n_local, nullptr));
  petsc::check(MatCreateDense(petsc::communicator(system.K), n_local, PETSC_DECIDE, PETSC_DETERMINE,
                              6, nullptr, R.put()));
  const Vector3d origin = centre_of_nodes(dofs);
  const int rank = petsc::rank(petsc::communicator(R));
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    const int number = dofs.number(node);
    if (number < dofs.first_number(rank) || number >= dofs.first_number(rank + 1)) continue;
    const Matrix6d motion = rigid_arm(dofs.position(node) - origin);
    for (const int c : dofs.components()) {
      const int row = *dofs.dof(node, c);
      for (int k = 0; k < 6; ++k) petsc::check(MatSetValue(R, row, k, motion(c, k), INSERT_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(R, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(R, MAT_FINAL_ASSEMBLY));
  return R;
}

}  // namespace chladni::plate
