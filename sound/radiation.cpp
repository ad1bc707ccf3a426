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
Eigen::VectorXcd impedances(const Source& source, double omega)
{
  const SurfaceMotion& motion = source.motion;
  const Medium& medium = source.air.medium;
  const AirPlan plan = plan_air(source.body.outline, source.air, omega, motion.antisymmetric());
  const auto mesh = std::make_shared<const AirMesh>(air_around(source.body.outline, plan));
  Eigen::VectorXcd Z = Eigen::VectorXcd::Zero(motion.residual().size());
  const auto add = [&](Exterior& exterior, const Eigen::MatrixXd& w) {
    const Field field = solve(exterior, w.cast<std::complex<double>>());
    Z += 2.0 * complex_power(field).diagonal();
  };
  if (!plan.meridian) {
    Exterior exterior(mesh, {medium, omega, 0}, plan.layer);
    add(exterior, motion.in_space(exterior.surface()));
    return Z;
  }
  for (std::size_t i = 0; i < motion.harmonics().size(); ++i) {
    const int n = motion.harmonics()[i];
    Exterior exterior(mesh, {medium, omega, n}, plan.layer);
    add(exterior, motion.on_meridian(exterior.surface(), i, Parity::cosine));
    if (n > 0) add(exterior, motion.on_meridian(exterior.surface(), i, Parity::sine));
  }
  return Z;
}

}  // namespace

squeal::Radiation radiation(const mbs_export::ModalBody& body, const Source& source,
                            const std::vector<int>& modes, double squeal_omega)
{
  const auto n = static_cast<Index>(modes.size());
  squeal::Radiation result{
      {}, Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  double omega = 0.0;
  Eigen::VectorXcd Z;
  for (Index i = 0; i < n; ++i) {
    const int mode = modes[std::size_t(i)];
    const double own = body.omega[mode];
    const double at = std::abs(own - squeal_omega) < near_squeal * own ? squeal_omega : own;
    if (std::abs(at - omega) > same_frequency * at) {
      omega = at;
      Z = impedances(source, omega);
    }
    result.mode_numbers.push_back(mode + 1);
    result.omega[i] = own;
    result.at[i] = omega;
    result.damping[i] = Z[i].real();
    result.added_mass[i] = Z[i].imag() / omega;
  }
  return result;
}

}  // namespace chladni::sound
