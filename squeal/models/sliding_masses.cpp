#include "squeal/models/sliding_masses.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "squeal/model_options.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/model_motion.hpp"
#include "squeal/models/parameters.hpp"
#include "squeal/numerics.hpp"

namespace chladni::squeal {

namespace {

/// q = (x, y, phi) of the centre of mass; the pad moves by y. The two ends of the foot are the
/// contact points, of which either may let go.
SlidingMasses sliding_masses(const TiltingBlock& block);

Places places_in(TiltingBlock& block);

/// An end of the foot at the distance s from the centre of mass, along the motion of the surface.
SlidingPoint end_of_foot(const TiltingBlock& o, double s)
{
  return {.along = Eigen::Vector3d{1.0, 0.0, -o.height},
          .normal = Eigen::Vector3d{0.0, 1.0, s},
          .stiffness = 0.5 * o.contact_stiffness,
          .preload = 0.5 * o.preload};
}

SlidingMasses sliding_masses(const TiltingBlock& o)
{
  return {.M = Eigen::Vector3d{o.mass, o.mass, o.inertia},
          .D = Eigen::Vector3d{o.d_x, o.d_y, o.d_phi}.asDiagonal().toDenseMatrix(),
          .K = Eigen::Vector3d{o.k_x, o.k_y, o.k_phi}.asDiagonal().toDenseMatrix(),
          .points = {end_of_foot(o, o.foot_offset - 0.5 * o.foot_length),
                     end_of_foot(o, o.foot_offset + 0.5 * o.foot_length)},
          .observed = 1,
          .radius = o.radius,
          .friction = o.friction,
          .law = o.law};
}

Places places_in(TiltingBlock& o)
{
  return {{"friction", &o.friction.kinetic},
          {"preload", &o.preload},
          {"stiffness", &o.contact_stiffness},
          {"tilting_block.mass", &o.mass},
          {"tilting_block.inertia", &o.inertia},
          {"tilting_block.stiffness_along", &o.k_x},
          {"tilting_block.stiffness_normal", &o.k_y},
          {"tilting_block.stiffness_tilting", &o.k_phi},
          {"tilting_block.damping_along", &o.d_x},
          {"tilting_block.damping_normal", &o.d_y},
          {"tilting_block.damping_tilting", &o.d_phi},
          {"tilting_block.height", &o.height},
          {"tilting_block.foot_length", &o.foot_length},
          {"tilting_block.foot_offset", &o.foot_offset},
          {"tilting_block.contact_stiffness", &o.contact_stiffness},
          {"tilting_block.preload", &o.preload},
          {"tilting_block.radius", &o.radius}};
}

/// q = (x_1, x_2) of pad and disc; the pad moves by x_1. The normal force is constant.
SlidingMasses sliding_masses(const TwoMasses& masses);

Places places_in(TwoMasses& masses);

SlidingMasses sliding_masses(const TwoMasses& o)
{
  return {.M = Eigen::Vector2d{o.m_1, o.m_2},
          .D = Eigen::Vector2d{o.d_1, o.d_2}.asDiagonal().toDenseMatrix(),
          .K = Eigen::Vector2d{o.k_1, o.k_2}.asDiagonal().toDenseMatrix(),
          .points = {{.along = Eigen::Vector2d{1.0, -1.0},
                      .normal = Eigen::Vector2d::Zero(),
                      .stiffness = 0.0,
                      .preload = o.preload}},
          .observed = 0,
          .radius = o.radius,
          .friction = o.friction,
          .law = ContactLaw::signed_force};
}

Places places_in(TwoMasses& o)
{
  return {{"friction", &o.friction.kinetic},     {"preload", &o.preload},
          {"two_masses.pad_mass", &o.m_1},       {"two_masses.pad_stiffness", &o.k_1},
          {"two_masses.pad_damping", &o.d_1},    {"two_masses.disc_mass", &o.m_2},
          {"two_masses.disc_stiffness", &o.k_2}, {"two_masses.disc_damping", &o.d_2},
          {"two_masses.preload", &o.preload},    {"two_masses.radius", &o.radius}};
}

template <class Scalar>
struct MotionOfMasses {
  FewVector<Scalar> q, q_dot;
};

template <class Scalar>
struct PointForce {
  Scalar N;         ///< N
  Scalar friction;  ///< T on the mass, along the motion of the surface, N
  Scalar slip;      ///< v_r, m/s
};

/// Brings q to the size of its rates.
double scale_of_masses(const SlidingMasses& s)
{
  return std::sqrt(s.K(0, 0) / s.M[0]);
}

template <class Scalar>
MotionOfMasses<Scalar> motion_of_masses(const SlidingMasses& s, const Eigen::VectorX<Scalar>& x)
{
  const Eigen::Index n = s.M.size();
  return {x.head(n) / scale_of_masses(s), x.tail(n)};
}

/// W . v
template <class Scalar>
Scalar along(const FewVector<double>& W, const FewVector<Scalar>& v)
{
  Scalar sum(0.0);
  for (Eigen::Index i = 0; i < W.size(); ++i) sum += W[i] * v[i];
  return sum;
}

/// @param law  yields N and the sign of the friction from the force that a contact would have if it
///             could pull
template <class Scalar, class Law>
PointForce<Scalar> force_at(const SlidingMasses& s, const SlidingPoint& point,
                            const MotionOfMasses<Scalar>& m, double speed, const Law& law)
{
  const Scalar v_r = s.radius * speed - along(point.along, m.q_dot);
  const Scalar v = regularised_speed(s.friction, Scalar(v_r * v_r));
  const auto [N, g] = law(Scalar(point.preload + point.stiffness * along(point.normal, m.q)));
  return {N, g * friction_coefficient(s.friction, v) * N * v_r / v, v_r};
}

double friction_at_rest(const SlidingMasses& s, const SlidingPoint& point, double speed)
{
  const double V = s.radius * speed, v = regularised_speed(s.friction, V * V);
  return friction_coefficient(s.friction, v) * point.preload * V / v;
}

/// x' of (w q, q') with the forces that `force_of(i, point)` yields.
template <class Scalar, class Forces>
Eigen::VectorX<Scalar> rate_of_masses(const SlidingMasses& s, const MotionOfMasses<Scalar>& m,
                                      double speed, const Forces& force_of)
{
  FewVector<Scalar> Q = -(s.D.cast<Scalar>() * m.q_dot) - s.K.cast<Scalar>() * m.q;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const SlidingPoint& point = s.points[i];
    const PointForce<Scalar> force = force_of(i, point);
    Q += point.along.cast<Scalar>() * (force.friction - friction_at_rest(s, point, speed)) -
         point.normal.cast<Scalar>() * (force.N - point.preload);
  }
  Eigen::VectorX<Scalar> rate(2 * s.M.size());
  rate << scale_of_masses(s) * m.q_dot, Q.cwiseQuotient(s.M.cast<Scalar>());
  return rate;
}

template <class Scalar>
PointForce<Scalar> force_by_law(const SlidingMasses& s, const SlidingPoint& point,
                                const MotionOfMasses<Scalar>& m, double speed)
{
  return force_at(s, point, m, speed,
                  [&](const Scalar& S) { return axial_force<Scalar>(s.law, S); });
}

template <class Scalar>
Eigen::VectorX<Scalar> rate_by_law(const SlidingMasses& s, const Eigen::VectorX<Scalar>& x,
                                   double speed)
{
  const MotionOfMasses<Scalar> m = motion_of_masses(s, x);
  return rate_of_masses(s, m, speed, [&](std::size_t /*i*/, const SlidingPoint& point) {
    return force_by_law(s, point, m, speed);
  });
}

PadState<double> pad_at(const SlidingMasses& s, const SlidingPoint& point,
                        const MotionOfMasses<double>& m, double speed)
{
  const PointForce<double> force = force_by_law(s, point, m, speed);
  return {.z = m.q[s.observed],
          .z_dot = m.q_dot[s.observed],
          .N = force.N,
          .slip_speed = std::abs(force.slip),
          .S = force.N,
          .f_r = 0.0,
          .f_t = force.friction};
}

ContactResult<double> pads_at(const SlidingMasses& s, const Eigen::VectorXd& x, double speed)
{
  const MotionOfMasses<double> m = motion_of_masses(s, x);
  return {.upper = pad_at(s, s.points.front(), m, speed),
          .lower = pad_at(s, s.points.back(), m, speed)};
}

/// For ModelMotion: the equations at a speed.
struct SlidingEquationsAt {
  SlidingMasses s;
  double speed;

  template <class Scalar>
  SwitchedRate<Scalar> evaluate(const Eigen::VectorX<Scalar>& x,
                                const Eigen::VectorXd& branches) const
  {
    const MotionOfMasses<Scalar> m = motion_of_masses(s, x);
    Eigen::VectorX<Scalar> pressure(static_cast<Eigen::Index>(s.points.size()));
    const auto force_of = [&](std::size_t i, const SlidingPoint& point) {
      const auto j = static_cast<Eigen::Index>(i);
      pressure[j] = 1.0 + point.stiffness * along(point.normal, m.q) / point.preload;
      const double g = branches[j];
      return force_at(s, point, m, speed, [g](const Scalar& S) {
        return AxialForce<Scalar>{g == 0.0 ? Scalar(0.0) : S, g};
      });
    };
    Eigen::VectorX<Scalar> f = rate_of_masses(s, m, speed, force_of);
    return {std::move(f), std::move(pressure)};
  }
  ContactResult<double> contact(const Eigen::VectorXd& x) const { return pads_at(s, x, speed); }
};

/// A bound of the frequencies of the masses in contact, rad/s: Gershgorin's of M^-1/2 K M^-1/2.
double highest_frequency_of_masses(const SlidingMasses& s)
{
  FewMatrix K = s.K;
  for (const SlidingPoint& point : s.points)
    K += point.stiffness * point.normal * point.normal.transpose();
  const FewVector<double> root = s.M.cwiseSqrt().cwiseInverse();
  const FewMatrix scaled = root.asDiagonal() * K * root.asDiagonal();
  return std::sqrt(scaled.cwiseAbs().rowwise().sum().maxCoeff());
}

SlidingMasses masses_of(const SlidingBrake::Model& model)
{
  return std::visit([](const auto& own) { return sliding_masses(own); }, model);
}

Places places_of(SlidingBrake::Model& model)
{
  return std::visit([](auto& own) { return places_in(own); }, model);
}

FrictionLaw& friction_of(SlidingBrake::Model& model)
{
  return std::visit([](auto& own) -> FrictionLaw& { return own.friction; }, model);
}

}  // namespace

SlidingBrake::SlidingBrake(const Model& model) : model_(model), masses_(masses_of(model)) {}

Eigen::MatrixXd SlidingBrake::state_matrix(double speed) const
{
  return derivative_at_rest(
      [&](const Eigen::VectorXcd& x) { return rate_by_law(masses_, x, speed); }, size());
}

std::unique_ptr<Brake> SlidingBrake::with(MapParameter parameter, double value) const
{
  Model changed = model_;
  if (is_of_law(parameter)) {
    FrictionLaw& law = friction_of(changed);
    law = with_friction_parameter(law, parameter, value);
    return std::make_unique<SlidingBrake>(changed);
  }
  double* at = nullptr;
  for (const auto& [name, place] : places_of(changed))
    if (name == parameter.name && parameter.pad == 0) at = place;
  set_parameter(at, parameter, value);
  return std::make_unique<SlidingBrake>(changed);
}

std::vector<ParameterValue> SlidingBrake::parameters() const
{
  Model model = model_;
  std::vector<ParameterValue> values = friction_parameters(friction_of(model));
  for (const auto& [name, place] : places_of(model))
    if (name.find('.') != std::string_view::npos) values.push_back({{name}, *place});
  return values;
}

std::unique_ptr<AutonomousMotion> SlidingBrake::motion(double speed) const
{
  return std::make_unique<ModelMotion<SlidingEquationsAt>>(
      SlidingEquationsAt{masses_, speed},
      ModelMotion<SlidingEquationsAt>::Properties{
          .size = size(),
          .n_switches = static_cast<Eigen::Index>(masses_.points.size()),
          .omega_highest = highest_frequency_of_masses(masses_),
          .law = masses_.law});
}

double SlidingBrake::rest_compression() const
{
  const SlidingPoint& point = masses_.points.front();
  const Eigen::Index i = masses_.observed;
  return point.preload / (point.stiffness > 0.0 ? point.stiffness : masses_.K(i, i));
}

Eigen::VectorXd SlidingBrake::rate(const Eigen::VectorXd& x, double speed) const
{
  return rate_by_law(masses_, x, speed);
}

ContactResult<double> SlidingBrake::contact(const Eigen::VectorXd& x, double speed) const
{
  return pads_at(masses_, x, speed);
}

Eigen::VectorXd SlidingBrake::start(double displacement) const
{
  return scale_of_masses(masses_) * displacement * Eigen::VectorXd::Unit(size(), masses_.observed);
}

SlidingMasses sliding_masses(const Oscillator& o)
{
  return {.M = Eigen::Vector2d{o.mass, o.mass},
          .D = Eigen::Vector2d{o.d_x, o.d_y}.asDiagonal().toDenseMatrix(),
          .K = Eigen::Matrix2d{{o.k_x, o.k_xy}, {o.k_xy, o.k_y}},
          .points = {{.along = Eigen::Vector2d{1.0, 0.0},
                      .normal = Eigen::Vector2d{0.0, 1.0},
                      .stiffness = o.contact_stiffness,
                      .preload = o.preload}},
          .observed = 1,
          .radius = o.radius,
          .friction = o.friction,
          .law = o.law};
}

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

double flutter_friction(const Oscillator& o)
{
  const double half = 0.5 * (o.k_x - o.k_y - o.contact_stiffness);
  return (half * half + o.k_xy * o.k_xy) / (o.k_xy * o.contact_stiffness);
}

}  // namespace chladni::squeal
