#include "mbs_export/stiffening.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/error.hpp"
#include "mbs_export/mass_integrals.hpp"

namespace chladni::mbs_export {

using Eigen::MatrixXd;

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
