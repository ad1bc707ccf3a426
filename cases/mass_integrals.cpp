#include "cases/mass_integrals.hpp"

#include <vector>

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
  // Not at once: all of them are larger than M. Of zz: M = S_xx + S_yy + S_zz.
  for (const auto& some : {std::vector<std::size_t>{0, 1, 3}, {4, 5}}) {
    std::vector<plate::Axes> axes;
    for (const std::size_t i : some) axes.push_back(mbs_export::product_axes[i]);
    const std::vector<petsc::Matrix> products = plate::displacement_products(model, axes);
    std::vector<linear::SparseForm> forms;
    for (std::size_t n = 0; n < some.size(); ++n) {
      const bool is_symmetric = axes[n].first == axes[n].second;
      forms.push_back({.A = products[n],
                       .symmetry = is_symmetric ? FormSymmetry::symmetric : FormSymmetry::none});
    }
    const std::vector<MatrixXd> reduced_forms =
        reduce::project_forms(reduced.reduction.Q_CB, reduced.body.dofs, forms);
    for (std::size_t n = 0; n < some.size(); ++n)
      S[some[n]] = reduced_forms[n](reduced.places, reduced.places);
  }
  S[2] = reduced.system.M - S[0] - S[1];
  return integrals;
}

}  // namespace chladni::cases
