#include "squeal/models/rigid_disc_brake.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "common/error.hpp"
#include "squeal/derivative.hpp"
#include "squeal/models/brake_numbers.hpp"
#include "squeal/models/friction_parameters.hpp"
#include "squeal/models/model_motion.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

/// sqrt(k_t / Theta): brings the angles of x to the size of their rates.
double scale_of(const RigidDisc& disc)
{
  return std::sqrt(disc.k_t / disc.Theta);
}

template <class Scalar>
RigidMotion<Scalar> motion_of(const RigidDisc& disc, Drive drive, const Eigen::VectorX<Scalar>& x,
                              double speed)
{
  Scalar spin(speed);
  if (drive == Drive::moment) spin += x[4];
  return {x.template head<2>() / scale_of(disc), x.template segment<2>(2), spin};
}

template <class Scalar>
RigidAcceleration<Scalar> acceleration(const RigidDisc& disc, Drive drive,
                                       const Eigen::VectorX<Scalar>& x, double speed)
{
  return accelerate(disc, motion_of(disc, drive, x, speed), drive);
}

/// x' of these accelerations.
template <class Scalar>
Eigen::VectorX<Scalar> rate_of(const RigidDisc& disc, Drive drive, const Eigen::VectorX<Scalar>& x,
                               const RigidAcceleration<Scalar>& a)
{
  Eigen::VectorX<Scalar> rate(x.size());
  rate.template head<2>() = scale_of(disc) * x.template segment<2>(2);
  rate.template segment<2>(2) = a.q_ddot;
  if (drive == Drive::moment) rate[4] = a.spin_rate;
  return rate;
}

template <class Scalar>
Eigen::VectorX<Scalar> rate_of(const RigidDisc& disc, Drive drive, const Eigen::VectorX<Scalar>& x,
                               double speed)
{
  return rate_of(disc, drive, x, acceleration(disc, drive, x, speed));
}

template <class Scalar>
PadState<double> pad_state(const RigidPad<Scalar>& pad, double (*part)(const Scalar&))
{
  return {.z = part(pad.z),
          .z_dot = part(pad.z_dot),
          .N = part(pad.N),
          .slip_speed = part(pad.slip_speed),
          .S = part(pad.S),
          .f_r = part(-pad.F[1]),  // the pads stand at (0, -r_0)
          .f_t = part(pad.F[0])};
}

ContactResult<double> pads_of(const PadState<double>& up, const PadState<double>& lo)
{
  return {.upper = up, .lower = lo};
}

PadState<double> sum(const PadState<double>& a, const PadState<double>& b)
{
  return {a.z + b.z, a.z_dot + b.z_dot, a.N + b.N,    a.slip_speed + b.slip_speed,
          a.S + b.S, a.f_r + b.f_r,     a.f_t + b.f_t};
}

/// The pads to first order in x: values at rest and their derivative along x.
ContactResult<double> linear_pads(const RigidDisc& disc, Drive drive, const Eigen::VectorXd& x,
                                  double speed)
{
  const Eigen::VectorXcd along = Complex(0.0, complex_step) * x.cast<Complex>();
  const RigidAcceleration<Complex> a = acceleration(disc, drive, along, speed);
  const auto value = [](const Complex& y) { return y.real(); };
  const auto slope = [](const Complex& y) { return y.imag() / complex_step; };
  return pads_of(sum(pad_state<Complex>(a.upper, value), pad_state<Complex>(a.upper, slope)),
                 sum(pad_state<Complex>(a.lower, value), pad_state<Complex>(a.lower, slope)));
}

ContactResult<double> nonlinear_pads(const RigidDisc& disc, Drive drive, const Eigen::VectorXd& x,
                                     double speed)
{
  const RigidAcceleration<double> a = acceleration(disc, drive, x, speed);
  const auto value = [](const double& y) { return y; };
  return pads_of(pad_state<double>(a.upper, value), pad_state<double>(a.lower, value));
}

/// For ModelMotion: the nonlinear equations at a speed.
struct RigidEquationsAt {
  RigidDisc disc;
  Drive drive;
  double speed;

  template <class Scalar>
  SwitchedRate<Scalar> evaluate(const Eigen::VectorX<Scalar>& x,
                                const Eigen::VectorXd& branches) const
  {
    const RigidAcceleration<Scalar> a = accelerate_on_branches<Scalar>(
        disc, motion_of(disc, drive, x, speed), drive, {branches[0], branches[1]});
    return {rate_of(disc, drive, x, a),
            Eigen::Vector2<Scalar>(a.upper.S_free, a.lower.S_free) / disc.preload};
  }
  ContactResult<double> contact(const Eigen::VectorXd& x) const
  {
    return nonlinear_pads(disc, drive, x, speed);
  }
};

/// The springs of the pads raise the frequency of the disc on its own springs.
double highest_frequency(const RigidDisc& disc)
{
  const double k = disc.k_t + 2.0 * disc.spring.linear * disc.radius * disc.radius;
  return std::sqrt(k / disc.Theta);
}

}  // namespace

Eigen::MatrixXd RigidDiscBrake::state_matrix(double speed) const
{
  return derivative_at_rest(
             [&](const Eigen::VectorXcd& x) {
               return rate_of(study_.disc, study_.drive, x, speed);
             },
             size())
      .topLeftCorner<4, 4>();
}

namespace {

using Places = std::vector<std::pair<std::string_view, double*>>;

Places places_in(RigidDisc& disc)
{
  return {{"friction", &disc.friction.kinetic},    {"preload", &disc.preload},
          {"stiffness", &disc.spring.linear},      {"damping", &disc.damping},
          {"thickness", &disc.thickness},          {"rigid_disc.diametral_inertia", &disc.Theta},
          {"rigid_disc.axial_inertia", &disc.Phi}, {"rigid_disc.stiffness", &disc.k_t},
          {"rigid_disc.damping", &disc.d_t},       {"rigid_disc.pad_radius", &disc.radius}};
}

}  // namespace

std::unique_ptr<Brake> RigidDiscBrake::with(MapParameter parameter, double value) const
{
  RigidDiscStudy changed = study_;
  if (is_of_law(parameter)) {
    changed.disc.friction = with_friction_parameter(changed.disc.friction, parameter, value);
    return std::make_unique<RigidDiscBrake>(changed);
  }
  double* at = nullptr;
  for (const auto& [name, place] : places_in(changed.disc))
    if (name == parameter.name && parameter.pad <= 1) at = place;
  set_parameter(at, parameter, value);
  return std::make_unique<RigidDiscBrake>(changed);
}

std::vector<ParameterValue> RigidDiscBrake::parameters() const
{
  RigidDisc disc = study_.disc;
  std::vector<ParameterValue> values = friction_parameters(disc.friction);
  for (const auto& [name, place] : places_in(disc)) {
    const bool is_of_pad = name == "preload" || name == "stiffness" || name == "damping";
    if (name != "friction") values.push_back({{name, is_of_pad ? 1 : 0}, *place});
  }
  return values;
}

std::vector<BrakeNumber> RigidDiscBrake::further_numbers() const
{
  return friction_point_numbers(study_.disc.friction, "friction", [this](FrictionLaw law) {
    RigidDiscStudy changed = study_;
    changed.disc.friction = std::move(law);
    return std::make_unique<RigidDiscBrake>(changed);
  });
}

std::unique_ptr<AutonomousMotion> RigidDiscBrake::motion(double speed) const
{
  if (study_.equations == RigidEquations::linear) {
    throw Error(
        "limit cycle: the linearised equations of the rigid disc have none; take equations = "
        "\"nonlinear\"");
  }
  return std::make_unique<ModelMotion<RigidEquationsAt>>(
      RigidEquationsAt{study_.disc, study_.drive, speed},
      ModelMotion<RigidEquationsAt>::Properties{.size = size(),
                                                .n_switches = 2,
                                                .omega_highest = highest_frequency(study_.disc),
                                                .law = study_.disc.law});
}

double RigidDiscBrake::rest_compression() const
{
  return study_.disc.preload / study_.disc.spring.linear;
}

Eigen::VectorXd RigidDiscBrake::rate(const Eigen::VectorXd& x, double speed) const
{
  if (study_.equations == RigidEquations::nonlinear)
    return rate_of(study_.disc, study_.drive, x, speed);
  const Eigen::VectorXcd along = Complex(0.0, complex_step) * x.cast<Complex>();
  return rate_of(study_.disc, study_.drive, along, speed).imag() / complex_step;
}

ContactResult<double> RigidDiscBrake::contact(const Eigen::VectorXd& x, double speed) const
{
  return study_.equations == RigidEquations::linear
             ? linear_pads(study_.disc, study_.drive, x, speed)
             : nonlinear_pads(study_.disc, study_.drive, x, speed);
}

/// The upper pad is displaced by r_0 tan(q_1) + ... = r_0 q_1 to first order.
Eigen::VectorXd RigidDiscBrake::start(double displacement) const
{
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
  x[0] = -scale_of(study_.disc) * displacement / study_.disc.radius;
  return x;
}

}  // namespace chladni::squeal
