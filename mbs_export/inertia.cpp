#include "mbs_export/inertia.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/error.hpp"

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

const std::array<std::string, 12> stiffening_loads{
    "omega_xx", "omega_yy", "omega_zz", "omega_xy",       "omega_yz",       "omega_zx",
    "alpha_x",  "alpha_y",  "alpha_z",  "acceleration_x", "acceleration_y", "acceleration_z"};

Stiffening in_coordinates(const Stiffening& stiffening, const MatrixXd& T)
{
  Stiffening transformed = stiffening;
  for (MatrixXd& K : transformed.K) K = T.transpose() * (K * T);
  return transformed;
}

const MatrixXd& stiffening_by(const Stiffening& stiffening, const std::string& load)
{
  const auto found = std::ranges::find(stiffening.loads, load);
  if (found == stiffening.loads.end()) {
    throw Error(fmt::format(
        "stiffening: no matrix of the load {}; there are those of: {}. reduce.stiffening says "
        "which loads are computed",
        load, fmt::join(stiffening.loads, ", ")));
  }
  return stiffening.K[static_cast<std::size_t>(found - stiffening.loads.begin())];
}

MatrixXd spin_stiffening(const Stiffening& stiffening, const Eigen::Vector3d& e)
{
  const Eigen::Index n = stiffening.K.empty() ? 0 : stiffening.K.front().rows();
  MatrixXd K = MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < product_axes.size(); ++i) {
    const auto [k, l] = product_axes[i];
    const double factor = e[k] * e[l];
    if (factor != 0.0) K += factor * stiffening_by(stiffening, stiffening_loads[i]);
  }
  return K;
}

}  // namespace chladni::mbs_export
