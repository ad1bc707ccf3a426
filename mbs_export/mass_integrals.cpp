#include "mbs_export/mass_integrals.hpp"

#include <algorithm>

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

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

MatrixXd centrifugal_matrix(const MassIntegrals& integrals, const Vector3d& e)
{
  // (e x phi_i) . (e x phi_j) = phi_i . phi_j - (e . phi_i) (e . phi_j) for |e| = 1
  MatrixXd Z = MatrixXd::Zero(integrals.displacement.cols(), integrals.displacement.cols());
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      const double weight = (k == l ? 1.0 : 0.0) - e[k] * e[l];
      if (weight != 0.0) Z += weight * displacement_product(integrals, k, l);
    }
  }
  return Z;
}

VectorXd centrifugal_load(const MassIntegrals& integrals, const Vector3d& e)
{
  VectorXd z = VectorXd::Zero(integrals.displacement.cols());
  for (Index k = 0; k < 3; ++k) {
    for (Index l = 0; l < 3; ++l) {
      const double weight = (k == l ? 1.0 : 0.0) - e[k] * e[l];
      z += weight * integrals.position_displacement.row(3 * k + l).transpose();
    }
  }
  return z;
}

}  // namespace chladni::mbs_export
