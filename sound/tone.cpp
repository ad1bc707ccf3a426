#include "sound/tone.hpp"

#include <cmath>

namespace chladni::sound {
namespace {

using Eigen::Index, Eigen::MatrixX3d, Eigen::MatrixXcd, Eigen::VectorXcd;
using Complex = std::complex<double>;

constexpr double silent = 1e-9;

void add_field(Tone& tone, Exterior& exterior, const MatrixXcd& v_n)
{
  tone.fields.push_back(solve(exterior, v_n));
  tone.n_unknowns += exterior.n_unknowns();
  tone.memory_MiB = std::max(tone.memory_MiB, exterior.memory_MiB());
}

/// @param velocity  [n_modes] complex amplitudes of the velocities of the modes
Tone tone_of(const Source& source, int h, double omega, const VectorXcd& velocity)
{
  const SurfaceMotion& motion = source.motion;
  const AirPlan plan = plan_air(source.body.outline, source.air, omega, motion.antisymmetric());
  const auto mesh = std::make_shared<const AirMesh>(air_around(source.body.outline, plan));
  Tone tone{h, omega, 0, mesh->n_elements(), 0.0, {}};
  if (!plan.meridian) {
    Exterior exterior(mesh, {source.air.medium, omega, 0}, plan.layer);
    add_field(tone, exterior, motion.in_space(exterior.surface()).cast<Complex>() * velocity);
    return tone;
  }
  for (std::size_t i = 0; i < motion.harmonics().size(); ++i) {
    Exterior exterior(mesh, {source.air.medium, omega, motion.harmonics()[i]}, plan.layer);
    MatrixXcd v_n(exterior.surface().n_points(), 2);
    v_n.col(0) =
        motion.on_meridian(exterior.surface(), i, Parity::cosine).cast<Complex>() * velocity;
    v_n.col(1) = motion.on_meridian(exterior.surface(), i, Parity::sine).cast<Complex>() * velocity;
    if (motion.harmonics()[i] == 0) v_n.col(1).setZero();
    add_field(tone, exterior, v_n);
  }
  return tone;
}

using Evaluate = MatrixXcd (*)(const Field&, const MatrixX3d&);

/// The columns of a meridian plane joined by cos(n phi) and sin(n phi); points that follow one
/// another on a circle around the axis are evaluated once.
VectorXcd joined(const Tone& tone, const MatrixX3d& x, Evaluate evaluate)
{
  VectorXcd p = VectorXcd::Zero(x.rows());
  for (const Field& field : tone.fields) {
    if (field.mesh->dimension() == 3) {
      p += evaluate(field, x).col(0);
      continue;
    }
    MatrixXcd amplitude;
    double last_r = -1.0, last_z = 0.0;
    for (Index i = 0; i < x.rows(); ++i) {
      const double r = x.row(i).head<2>().norm(), z = x(i, 2);
      if (std::abs(r - last_r) > 1e-12 * r || z != last_z)
        amplitude = evaluate(field, Eigen::RowVector3d(r, 0.0, z));
      last_r = r;
      last_z = z;
      const double phase = field.wave.n * std::atan2(x(i, 1), x(i, 0));
      p[i] += amplitude(0, 0) * std::cos(phase) + amplitude(0, 1) * std::sin(phase);
    }
  }
  return p;
}

}  // namespace

std::vector<Tone> tones(const Source& source, const Vibration& vibration, int n_harmonics)
{
  std::vector<Tone> all;
  double first = 0.0;
  for (int h = 1; h <= std::min<Index>(n_harmonics, vibration.harmonics.cols()); ++h) {
    const double omega = h * vibration.omega;
    const VectorXcd velocity = Complex(0.0, omega) * vibration.harmonics.col(h - 1);
    if (h == 1) first = velocity.norm();
    if (velocity.norm() > silent * first) all.push_back(tone_of(source, h, omega, velocity));
  }
  return all;
}

VectorXcd pressure_at(const Tone& tone, const MatrixX3d& x)
{
  return joined(tone, x, static_cast<Evaluate>(pressure_at));
}

VectorXcd far_field(const Tone& tone, const MatrixX3d& directions)
{
  return joined(tone, directions, static_cast<Evaluate>(far_field));
}

double near_power(const Tone& tone)
{
  double power = 0.0;
  for (const Field& field : tone.fields) power += complex_power(field).diagonal().real().sum();
  return power;
}

double far_power(const Tone& tone)
{
  double power = 0.0;
  for (const Field& field : tone.fields) power += far_power(field).sum();
  return power;
}

}  // namespace chladni::sound
