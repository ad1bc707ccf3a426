#include "squeal/models/oscillator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "squeal/derivative.hpp"
#include "squeal/models/brake_numbers.hpp"
#include "squeal/models/friction_parameters.hpp"
#include "squeal/models/model_motion.hpp"

namespace chladni::squeal {
namespace {

template <class Scalar>
struct OscillatorContact {
  Scalar N;         ///< N
  Scalar friction;  ///< on the mass, along the motion of the surface, N
  Scalar slip;      ///< v_r, m/s
};

/// @param law  yields S and g from the force that the contact would have if it could pull
template <class Scalar, class Law>
OscillatorContact<Scalar> contact_under(const Oscillator& o, const Eigen::Vector4<Scalar>& motion,
                                        double speed, const Law& law)
{
  const Scalar v_r = o.radius * speed - motion[2];
  const Scalar v = regularised_speed(o.friction, Scalar(v_r * v_r));
  const auto [N, g] = law(Scalar(o.preload + o.contact_stiffness * motion[1]));
  return {N, g * friction_coefficient(o.friction, v) * N * v_r / v, v_r};
}

template <class Scalar>
OscillatorContact<Scalar> contact_of(const Oscillator& o, const Eigen::Vector4<Scalar>& motion,
                                     double speed)
{
  return contact_under(o, motion, speed,
                       [&](const Scalar& S) { return axial_force<Scalar>(o.law, S); });
}

/// (x', y', x'', y'') of (x, y, x', y') under this contact.
template <class Scalar>
Eigen::Vector4<Scalar> rate_of(const Oscillator& o, const Eigen::Vector4<Scalar>& motion,
                               double speed, const OscillatorContact<Scalar>& contact)
{
  const Scalar &x = motion[0], &y = motion[1], &u = motion[2], &w = motion[3];
  const double at_rest = contact_of<double>(o, Eigen::Vector4d::Zero(), speed).friction;
  return {u, w, (contact.friction - at_rest - o.d_x * u - o.k_x * x - o.k_xy * y) / o.mass,
          (o.preload - contact.N - o.d_y * w - o.k_xy * x - o.k_y * y) / o.mass};
}

template <class Scalar>
Eigen::Vector4<Scalar> rate_of(const Oscillator& o, const Eigen::Vector4<Scalar>& motion,
                               double speed)
{
  return rate_of(o, motion, speed, contact_of(o, motion, speed));
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

ContactResult<double> pads_of(const Oscillator& o, const Eigen::Vector4d& motion, double speed)
{
  const PadState<double> pad = pad_of(o, motion, speed);
  return {.upper = pad, .lower = pad};
}

/// For ModelMotion: the equations at a speed, x = scale (x, y, x', y').
struct OscillatorEquationsAt {
  Oscillator o;
  Eigen::Vector4d scale;
  double speed;

  template <class Scalar>
  SwitchedRate<Scalar> evaluate(const Eigen::VectorX<Scalar>& x,
                                const Eigen::VectorXd& branches) const
  {
    const Eigen::Vector4<Scalar> motion = x.cwiseQuotient(scale.cast<Scalar>());
    const double g = branches[0];
    const auto contact = contact_under(o, motion, speed, [g](const Scalar& S) {
      return AxialForce<Scalar>{g == 0.0 ? Scalar(0.0) : S, g};
    });
    const Eigen::VectorX<Scalar> pressure =
        Eigen::VectorX<Scalar>::Constant(1, 1.0 + o.contact_stiffness * motion[1] / o.preload);
    return {rate_of(o, motion, speed, contact).cwiseProduct(scale.cast<Scalar>()), pressure};
  }
  ContactResult<double> contact(const Eigen::VectorXd& x) const
  {
    return pads_of(o, x.cwiseQuotient(scale), speed);
  }
};

/// Brings the displacements of x to the size of their rates.
double scale_of(const Oscillator& o)
{
  return std::sqrt(o.k_x / o.mass);
}

Eigen::Vector4d scales_of(const Oscillator& o)
{
  return {scale_of(o), scale_of(o), 1.0, 1.0};
}

template <class Scalar>
Eigen::VectorX<Scalar> scaled_rate(const Oscillator& o, const Eigen::VectorX<Scalar>& x,
                                   double speed)
{
  const Eigen::Vector4d scale = scales_of(o);
  const Eigen::Vector4<Scalar> motion = x.cwiseQuotient(scale.cast<Scalar>());
  return rate_of<Scalar>(o, motion, speed).cwiseProduct(scale.cast<Scalar>());
}

}  // namespace

Eigen::MatrixXd OscillatorBrake::state_matrix(double speed) const
{
  return derivative_at_rest([&](const Eigen::VectorXcd& x) { return scaled_rate(o_, x, speed); },
                            size());
}

namespace {

using Places = std::vector<std::pair<std::string_view, double*>>;

/// By the keys of the scene; the first ones are names that all brakes share.
Places places_in(Oscillator& o)
{
  return {{"friction", &o.friction.kinetic},
          {"preload", &o.preload},
          {"stiffness", &o.contact_stiffness},
          {"oscillator.mass", &o.mass},
          {"oscillator.stiffness_along", &o.k_x},
          {"oscillator.stiffness_normal", &o.k_y},
          {"oscillator.stiffness_coupling", &o.k_xy},
          {"oscillator.damping_along", &o.d_x},
          {"oscillator.damping_normal", &o.d_y},
          {"oscillator.contact_stiffness", &o.contact_stiffness},
          {"oscillator.preload", &o.preload},
          {"oscillator.radius", &o.radius}};
}

}  // namespace

std::unique_ptr<Brake> OscillatorBrake::with(MapParameter parameter, double value) const
{
  Oscillator changed = o_;
  if (is_of_law(parameter)) {
    changed.friction = with_friction_parameter(changed.friction, parameter, value);
    return std::make_unique<OscillatorBrake>(changed);
  }
  double* at = nullptr;
  for (const auto& [name, place] : places_in(changed))
    if (name == parameter.name && parameter.pad == 0) at = place;
  set_parameter(at, parameter, value);
  return std::make_unique<OscillatorBrake>(changed);
}

std::vector<ParameterValue> OscillatorBrake::parameters() const
{
  Oscillator o = o_;
  std::vector<ParameterValue> values = friction_parameters(o.friction);
  for (const auto& [name, place] : places_in(o))
    if (name.starts_with("oscillator.")) values.push_back({{name}, *place});
  return values;
}

std::vector<BrakeNumber> OscillatorBrake::further_numbers() const
{
  return friction_point_numbers(o_.friction, "friction", [this](FrictionLaw law) {
    Oscillator changed = o_;
    changed.friction = std::move(law);
    return std::make_unique<OscillatorBrake>(changed);
  });
}

std::unique_ptr<AutonomousMotion> OscillatorBrake::motion(double speed) const
{
  const double highest =
      std::sqrt((std::max(o_.k_x, o_.k_y + o_.contact_stiffness) + o_.k_xy) / o_.mass);
  return std::make_unique<ModelMotion<OscillatorEquationsAt>>(
      OscillatorEquationsAt{o_, scales_of(o_), speed},
      ModelMotion<OscillatorEquationsAt>::Properties{
          .size = size(), .n_switches = 1, .omega_highest = highest, .law = o_.law});
}

Eigen::VectorXd OscillatorBrake::rate(const Eigen::VectorXd& x, double speed) const
{
  return scaled_rate(o_, x, speed);
}

ContactResult<double> OscillatorBrake::contact(const Eigen::VectorXd& x, double speed) const
{
  return pads_of(o_, x.cwiseQuotient(scales_of(o_)), speed);
}

Eigen::VectorXd OscillatorBrake::start(double displacement) const
{
  return Eigen::Vector4d{0.0, scale_of(o_) * displacement, 0.0, 0.0};
}

double flutter_friction(const Oscillator& o)
{
  const double half = 0.5 * (o.k_x - o.k_y - o.contact_stiffness);
  return (half * half + o.k_xy * o.k_xy) / (o.k_xy * o.contact_stiffness);
}

}  // namespace chladni::squeal
