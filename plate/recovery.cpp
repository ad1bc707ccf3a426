#include "plate/recovery.hpp"

namespace chladni::plate {

namespace {

using Eigen::MatrixXd;

/// All entries of a distributed vector, on every rank.
Eigen::VectorXd replicate(Vec q)
{
  VecScatter scatter = nullptr;
  petsc::Vector all;
  petsc::check(VecScatterCreateToAll(q, &scatter, all.put()));
  petsc::check(VecScatterBegin(scatter, q, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterEnd(scatter, q, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterDestroy(&scatter));
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  petsc::check(VecGetSize(all, &n));
  petsc::check(VecGetArrayRead(all, &values));
  Eigen::VectorXd copy = Eigen::Map<const Eigen::VectorXd>(values, n);
  petsc::check(VecRestoreArrayRead(all, &values));
  return copy;
}

}  // namespace

MatrixXd node_motions(const DofMap& dofs, Vec q)
{
  const Eigen::VectorXd all = replicate(q);
  MatrixXd motions = MatrixXd::Zero(dofs.n_nodes(), 6);
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (const MotionTerm& term : dofs.motion(node)) {
      motions.row(node) += term.T * all.segment<6>(6 * term.number);
    }
  }
  return motions;
}

MatrixXd reactions(const DofMap& dofs, const std::vector<int>& held, Vec residual)
{
  const Eigen::VectorXd all = replicate(residual);
  MatrixXd forces = MatrixXd::Zero(dofs.n_active(), 6);
  for (const int dof : held) forces(dof / 6, dof % 6) = all[dof];
  return forces;
}

}  // namespace chladni::plate
