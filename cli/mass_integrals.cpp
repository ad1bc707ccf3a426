#include "cli/mass_integrals.hpp"

#include "plate/inertia_integrals.hpp"

namespace chladni::cli {
namespace {

using Eigen::MatrixXd;

Eigen::Map<const MatrixXd> as_eigen(const reduce::SmallMatrix& A)
{
  return {A.values.data(), A.n_rows, A.n_cols};
}

}  // namespace

mbs_export::MassIntegrals mass_integrals(const plate::Structure& structure, const FeModel& fe,
                                         const Partitioned& blocks, const Reduced& reduced)
{
  const plate::MassModel model =
      plate::mass_model(fe.mesh, structure, fe.system.dofs, PETSC_COMM_WORLD);
  const plate::MassMoments moments = plate::mass_moments(model);
  const reduce::SmallMatrix rows =
      reduce::project_vectors(reduced.Q_CB, blocks.rows, moments.displacement);
  const MatrixXd V = as_eigen(rows)(reduced.places, Eigen::all).transpose();
  mbs_export::MassIntegrals integrals{.mass = moments.mass,
                                      .first = moments.first,
                                      .second = moments.second,
                                      .displacement = V.topRows<3>(),
                                      .position_displacement = V.bottomRows<9>(),
                                      .products = {}};
  const auto product = [&](int k, int l) -> MatrixXd {
    const petsc::Matrix S = plate::displacement_product(model, k, l);
    const reduce::SmallMatrix S_r =
        reduce::project_form(reduced.Q_CB, reduce::split(S, blocks.rows));
    return as_eigen(S_r)(reduced.places, reduced.places);
  };
  auto& S = integrals.products;
  for (const std::size_t i : {0, 1, 3, 4, 5}) {
    const auto [k, l] = mbs_export::product_axes[i];
    S[i] = product(k, l);
    if (k == l) S[i] = 0.5 * (S[i] + S[i].transpose()).eval();
  }
  S[2] = reduced.system.M - S[0] - S[1];  // M = S_xx + S_yy + S_zz
  return integrals;
}

}  // namespace chladni::cli
