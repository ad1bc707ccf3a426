#include "mbs_export/mass_integrals.hpp"

#include <algorithm>

namespace chladni::mbs_export {

using Eigen::MatrixXd, Eigen::Vector3d;

const std::array<std::pair<int, int>, 6> product_axes{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

MatrixXd displacement_product(const MassIntegrals& integrals, int k, int l)
{
  const auto place = [](int row, int column) {
    return std::ranges::find(product_axes, std::pair{row, column}) - product_axes.begin();
  };
  const auto direct = static_cast<std::size_t>(place(k, l));
  if (direct < product_axes.size()) return integrals.products[direct];
  return integrals.products[static_cast<std::size_t>(place(l, k))].transpose();
}

MassIntegrals in_coordinates(const MassIntegrals& integrals, const MatrixXd& T)
{
  MassIntegrals transformed = integrals;
  transformed.displacement = integrals.displacement * T;
  transformed.position_displacement = integrals.position_displacement * T;
  for (MatrixXd& S : transformed.products) S = T.transpose() * (S * T);
  return transformed;
}

MatrixXd gyroscopic_matrix(const MassIntegrals& integrals, const Vector3d& e)
{
  // phi_i . (e x phi_j) = e . (phi_j x phi_i)
  MatrixXd G = MatrixXd::Zero(integrals.displacement.cols(), integrals.displacement.cols());
  for (int k = 0; k < 3; ++k) {
    const MatrixXd S = displacement_product(integrals, (k + 1) % 3, (k + 2) % 3);
    G += 2.0 * e[k] * (S.transpose() - S);
  }
  return G;
}

}  // namespace chladni::mbs_export
