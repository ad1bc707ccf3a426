#include "sound/radiation.hpp"

#include <cmath>
#include <numeric>

#include "sound/field.hpp"

namespace chladni::sound {
namespace {

using Eigen::Index, Eigen::MatrixXcd;

/// Modes of nearly one frequency share a mesh: a relative difference of 1e-4 changes the radiation
/// by a few times that.
constexpr double same_frequency = 1e-4;

/// Where the radiation of a mode is evaluated, rad/s.
double evaluated_at(double own, double squeal_omega)
{
  return std::abs(own - squeal_omega) < near_squeal * own ? squeal_omega : own;
}

/// Angles by whose multiple the outline may be turned into itself: 2 pi / this; 0 for all angles.
int symmetry_of(const Outline& outline)
{
  int n = 0;
  for (const Holes& holes : outline.holes) n = std::gcd(n, holes.count);
  return n;
}

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
  for (const int mode : modes)  // all are looked at before the first is solved
    plan_air(source.body.outline, source.air, evaluated_at(body.omega[mode], squeal_omega),
             source.motion.antisymmetric());
  double omega = 0.0;
  Eigen::VectorXcd Z;
  for (Index i = 0; i < n; ++i) {
    const int mode = modes[std::size_t(i)];
    const double own = body.omega[mode];
    const double at = evaluated_at(own, squeal_omega);
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

squeal::Radiation even_over_pairs(squeal::Radiation radiation, const squeal::Disc& disc,
                                  const Outline& outline)
{
  const std::vector<int> n = squeal::nodal_diameters(disc);
  const int symmetry = symmetry_of(outline);
  std::vector<char> taken(n.size(), 0);
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (taken[i] || n[i] == 0 || (symmetry != 0 && 2 * n[i] % symmetry == 0)) continue;
    std::size_t j = i + 1;
    while (j < n.size() && (taken[j] || n[j] != n[i])) ++j;
    if (j == n.size()) continue;
    taken[j] = 1;
    for (Eigen::VectorXd* x : {&radiation.damping, &radiation.added_mass})
      (*x)[Index(i)] = (*x)[Index(j)] = 0.5 * ((*x)[Index(i)] + (*x)[Index(j)]);
  }
  return radiation;
}

}  // namespace chladni::sound
