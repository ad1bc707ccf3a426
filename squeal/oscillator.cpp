#include "squeal/oscillator.hpp"

#include <cmath>

#include "squeal/derivative.hpp"

namespace chladni::squeal {
namespace {

template <class Scalar>
struct OscillatorContact {
  Scalar N;         ///< N
  Scalar friction;  ///< on the mass, along the motion of the surface, N
  Scalar slip;      ///< v_r, m/s
};

template <class Scalar>
OscillatorContact<Scalar> contact_of(const Oscillator& o, const Eigen::Vector4<Scalar>& motion,
                                     double speed)
{
  const Scalar v_r = o.radius * speed - motion[2];
  const Scalar v = regularised_speed(o.friction, Scalar(v_r * v_r));
  const auto [N, g] =
      axial_force<Scalar>(o.law, Scalar(o.preload + o.contact_stiffness * motion[1]));
  return {N, g * friction_coefficient(o.friction, v) * N * v_r / v, v_r};
}

/// (x', y', x'', y'') of (x, y, x', y').
template <class Scalar>
Eigen::Vector4<Scalar> rate_of(const Oscillator& o, const Eigen::Vector4<Scalar>& motion,
                               double speed)
{
  const Scalar &x = motion[0], &y = motion[1], &u = motion[2], &w = motion[3];
  const OscillatorContact<Scalar> contact = contact_of(o, motion, speed);
  const double at_rest = contact_of<double>(o, Eigen::Vector4d::Zero(), speed).friction;
  return {u, w, (contact.friction - at_rest - o.d_x * u - o.k_x * x - o.k_xy * y) / o.mass,
          (o.preload - contact.N - o.d_y * w - o.k_xy * x - o.k_y * y) / o.mass};
}

PadState<double> pad_of(const Oscillator& o, const Eigen::Vector4d& motion, double speed)
{
  const OscillatorContact<double> contact = contact_of(o, motion, speed);
  return {.z = motion[1],
          .z_dot = motion[3],
          .N = contact.N,
          .slip_speed = std::abs(contact.slip),
          .S = contact.N,
          .f_r = 0.0,
          .f_t = contact.friction};
}

}  // namespace

Model model_of(const Oscillator& o)
{
  const double omega = std::sqrt(o.k_x / o.mass);
  const Eigen::Vector4d scale{omega, omega, 1.0, 1.0};
  const auto scaled_rate = [o, scale]<class Scalar>(const Eigen::VectorX<Scalar>& x, double speed) {
    const Eigen::Vector4<Scalar> motion = x.cwiseQuotient(scale.cast<Scalar>());
    return Eigen::VectorX<Scalar>(
        rate_of<Scalar>(o, motion, speed).cwiseProduct(scale.cast<Scalar>()));
  };
  const auto pads = [o, scale](const Eigen::VectorXd& x, double speed) {
    const PadState<double> pad = pad_of(o, x.cwiseQuotient(scale), speed);
    const RingForce<double> force{pad.N, 0.0, pad.f_t};
    return ContactResult<double>{.force = force, .upper = pad, .lower = pad};
  };
  return {.size = 4,
          .state_matrix =
              [scaled_rate](double speed) {
                return derivative_at_rest(
                    [&](const Eigen::VectorXcd& x) { return scaled_rate(x, speed); }, 4);
              },
          .rate = [scaled_rate](const Eigen::VectorXd& x,
                                double speed) { return scaled_rate(x, speed); },
          .contact = pads,
          .start =
              [omega](double displacement) {
                return Eigen::VectorXd(Eigen::Vector4d{0.0, omega * displacement, 0.0, 0.0});
              },
          .rest_height = 0.0,
          .rest_compression = o.preload / o.contact_stiffness};
}

double flutter_friction(const Oscillator& o)
{
  const double half = 0.5 * (o.k_x - o.k_y - o.contact_stiffness);
  return (half * half + o.k_xy * o.k_xy) / (o.k_xy * o.contact_stiffness);
}

}  // namespace chladni::squeal
