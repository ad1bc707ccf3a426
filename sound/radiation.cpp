#include "sound/radiation.hpp"

#include <cmath>

#include "sound/field.hpp"

namespace chladni::sound {
namespace {

using Eigen::Index, Eigen::MatrixXcd;

/// Modes of nearly one frequency share a mesh: a relative difference of 1e-4 changes the radiation
/// by a few times that.
constexpr double same_frequency = 1e-4;

/// [n_modes] Z at one frequency.
Eigen::VectorXcd impedances(const ThickBody& thick, const SurfaceMotion& motion,
                            const AirOptions& air, double omega)
{
  const AirPlan plan = plan_air(thick.outline, air, omega, motion.antisymmetric());
  const auto mesh = std::make_shared<const AirMesh>(air_around(thick.outline, plan));
  Eigen::VectorXcd Z = Eigen::VectorXcd::Zero(motion.residual().size());
  const auto add = [&](Exterior& exterior, const Eigen::MatrixXd& w) {
    const Field field = solve(exterior, w.cast<std::complex<double>>());
    Z += 2.0 * complex_power(field).diagonal();
  };
  if (!plan.meridian) {
    Exterior exterior(mesh, {air.medium, omega, 0}, plan.layer);
    add(exterior, motion.in_space(exterior.surface()));
    return Z;
  }
  for (std::size_t i = 0; i < motion.harmonics().size(); ++i) {
    const int n = motion.harmonics()[i];
    Exterior exterior(mesh, {air.medium, omega, n}, plan.layer);
    add(exterior, motion.on_meridian(exterior.surface(), i, Parity::cosine));
    if (n > 0) add(exterior, motion.on_meridian(exterior.surface(), i, Parity::sine));
  }
  return Z;
}

}  // namespace

squeal::Radiation radiation(const mbs_export::ModalBody& body, const ThickBody& thick,
                            const SurfaceMotion& motion, const std::vector<int>& modes,
                            const AirOptions& air)
{
  const auto n = static_cast<Index>(modes.size());
  squeal::Radiation result{{}, Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  double omega = 0.0;
  Eigen::VectorXcd Z;
  for (Index i = 0; i < n; ++i) {
    const int mode = modes[std::size_t(i)];
    const double own = body.omega[mode];
    if (std::abs(own - omega) > same_frequency * own) {
      omega = own;
      Z = impedances(thick, motion, air, omega);
    }
    result.mode_numbers.push_back(mode + 1);
    result.omega[i] = own;
    result.damping[i] = Z[i].real();
    result.added_mass[i] = Z[i].imag() / omega;
  }
  return result;
}

}  // namespace chladni::sound
