#include "cases/sector_integrals.hpp"

#include "common/eigen_every.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd;

mbs_export::MassIntegrals sector_integrals(const SectorMass& mass,
                                           const std::vector<HarmonicPart>& parts,
                                           const MatrixXd& M, Index n_masters)
{
  const Index n = M.rows();
  const auto places = places_of(parts, n_masters);
  mbs_export::MassIntegrals whole = mass.of_rigid_body();
  whole.displacement = MatrixXd::Zero(3, n);
  whole.position_displacement = MatrixXd::Zero(9, n);
  auto& S = whole.products;
  for (MatrixXd& product : S) product = MatrixXd::Zero(n, n);
  for (std::size_t b = 0; b < parts.size(); ++b) {
    whole.displacement(every, places[b]) = parts[b].mass.displacement;
    whole.position_displacement(every, places[b]) = parts[b].mass.position_displacement;
    for (const MassCoupling& coupling : parts[b].mass.couplings) {
      const auto a = std::size_t(coupling.other);  // all orders are there
      for (const std::size_t i : {0, 1, 3, 4, 5}) {
        S[i](places[a], places[b]) = coupling.of_other[i];
        if (a != b) S[i](places[b], places[a]) = coupling.of_other_transposed[i];
      }
    }
  }
  for (const std::size_t i : {0, 1}) S[i] = 0.5 * (S[i] + S[i].transpose()).eval();
  S[2] = M - S[0] - S[1];  // M = S_xx + S_yy + S_zz
  return whole;
}

}  // namespace chladni::cases
