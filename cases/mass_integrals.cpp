#include "cases/mass_integrals.hpp"

#include "common/eigen_every.hpp"
#include "plate/assembly/inertia_integrals.hpp"
#include "reduce/project_form.hpp"

namespace chladni::cases {

using Eigen::MatrixXd, linear::FormSymmetry;

mbs_export::MassIntegrals mass_integrals(const plate::Structure& structure, const FeModel& fe,
                                         const SceneReduction& reduced)
{
  const plate::MassModel model =
      plate::mass_model(fe.mesh, structure, fe.system.dofs, PETSC_COMM_WORLD);
  const plate::MassMoments moments = plate::mass_moments(model);
  const MatrixXd V = reduce::project_vectors(reduced.reduction.Q_CB, reduced.body.dofs,
                                             moments.displacement)(reduced.places, every)
                         .transpose();
  mbs_export::MassIntegrals integrals{.mass = moments.mass,
                                      .first = moments.first,
                                      .second = moments.second,
                                      .displacement = V.topRows<3>(),
                                      .position_displacement = V.bottomRows<9>(),
                                      .products = {}};
  auto& S = integrals.products;
  for (const std::size_t i : {0, 1, 3, 4, 5}) {
    const auto [k, l] = mbs_export::product_axes[i];
    S[i] = projected(reduced, plate::displacement_product(model, k, l),
                     k == l ? FormSymmetry::symmetric : FormSymmetry::none);
    if (k == l) S[i] = 0.5 * (S[i] + S[i].transpose()).eval();
  }
  S[2] = reduced.system.M - S[0] - S[1];  // M = S_xx + S_yy + S_zz
  return integrals;
}

}  // namespace chladni::cases
