#include "cases/stiffening.hpp"

#include "plate/assembly/geometric_stiffness.hpp"

namespace chladni::cases {

mbs_export::Stiffening stiffening(const scene::Scene& scene, const FeModel& fe,
                                  const SceneReduction& reduced, const StressedStates& stressed)
{
  const plate::Structure structure = structure_of(scene);
  const plate::MassModel model =
      plate::mass_model(fe.mesh, structure, fe.system.dofs, PETSC_COMM_WORLD);
  mbs_export::Stiffening stiffening{.fixed = scene.body.fixed, .loads = stressed.loads, .K = {}};
  for (std::size_t i = 0; i < stressed.loads.size(); ++i) {
    Vec u = nullptr;
    petsc::check(MatDenseGetColumnVecRead(stressed.U, static_cast<PetscInt>(i), &u));
    const petsc::Matrix K =
        plate::geometric_stiffness(model, u, stressed.mass_loads.col(static_cast<Eigen::Index>(i)));
    petsc::check(MatDenseRestoreColumnVecRead(stressed.U, static_cast<PetscInt>(i), &u));
    const Eigen::MatrixXd K_r = projected(reduced, K, linear::FormSymmetry::symmetric);
    stiffening.K.push_back(0.5 * (K_r + K_r.transpose()));
  }
  return stiffening;
}

}  // namespace chladni::cases
