#include "squeal/models/sliding_brake.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "squeal/derivative.hpp"
#include "squeal/models/brake_numbers.hpp"
#include "squeal/models/friction_parameters.hpp"
#include "squeal/models/model_motion.hpp"
#include "squeal/models/oscillator.hpp"
#include "squeal/models/tilting_block.hpp"
#include "squeal/models/two_masses.hpp"

namespace chladni::squeal {
namespace {

template <class Scalar>
struct Motion {
  FewVector<Scalar> q, q_dot;
};

template <class Scalar>
struct PointForce {
  Scalar N;         ///< N
  Scalar friction;  ///< T on the mass, along the motion of the surface, N
  Scalar slip;      ///< v_r, m/s
};

/// Brings q to the size of its rates.
double scale_of(const SlidingMasses& s)
{
  return std::sqrt(s.K(0, 0) / s.M[0]);
}

template <class Scalar>
Motion<Scalar> motion_of(const SlidingMasses& s, const Eigen::VectorX<Scalar>& x)
{
  const Eigen::Index n = s.M.size();
  return {x.head(n) / scale_of(s), x.tail(n)};
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
                            const Motion<Scalar>& m, double speed, const Law& law)
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
Eigen::VectorX<Scalar> rate_of(const SlidingMasses& s, const Motion<Scalar>& m, double speed,
                               const Forces& force_of)
{
  FewVector<Scalar> Q = -(s.D.cast<Scalar>() * m.q_dot) - s.K.cast<Scalar>() * m.q;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const SlidingPoint& point = s.points[i];
    const PointForce<Scalar> force = force_of(i, point);
    Q += point.along.cast<Scalar>() * (force.friction - friction_at_rest(s, point, speed)) -
         point.normal.cast<Scalar>() * (force.N - point.preload);
  }
  Eigen::VectorX<Scalar> rate(2 * s.M.size());
  rate << scale_of(s) * m.q_dot, Q.cwiseQuotient(s.M.cast<Scalar>());
  return rate;
}

template <class Scalar>
PointForce<Scalar> force_by_law(const SlidingMasses& s, const SlidingPoint& point,
                                const Motion<Scalar>& m, double speed)
{
  return force_at(s, point, m, speed,
                  [&](const Scalar& S) { return axial_force<Scalar>(s.law, S); });
}

template <class Scalar>
Eigen::VectorX<Scalar> rate_by_law(const SlidingMasses& s, const Eigen::VectorX<Scalar>& x,
                                   double speed)
{
  const Motion<Scalar> m = motion_of(s, x);
  return rate_of(s, m, speed, [&](std::size_t /*i*/, const SlidingPoint& point) {
    return force_by_law(s, point, m, speed);
  });
}

PadState<double> pad_at(const SlidingMasses& s, const SlidingPoint& point, const Motion<double>& m,
                        double speed)
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
  const Motion<double> m = motion_of(s, x);
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
    const Motion<Scalar> m = motion_of(s, x);
    Eigen::VectorX<Scalar> pressure(static_cast<Eigen::Index>(s.points.size()));
    const auto force_of = [&](std::size_t i, const SlidingPoint& point) {
      const auto j = static_cast<Eigen::Index>(i);
      pressure[j] = 1.0 + point.stiffness * along(point.normal, m.q) / point.preload;
      const double g = branches[j];
      return force_at(s, point, m, speed, [g](const Scalar& S) {
        return AxialForce<Scalar>{g == 0.0 ? Scalar(0.0) : S, g};
      });
    };
    Eigen::VectorX<Scalar> f = rate_of(s, m, speed, force_of);
    return {std::move(f), std::move(pressure)};
  }
  ContactResult<double> contact(const Eigen::VectorXd& x) const { return pads_at(s, x, speed); }
};

/// A bound of the frequencies of the masses in contact, rad/s: Gershgorin's of M^-1/2 K M^-1/2.
double highest_frequency(const SlidingMasses& s)
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

std::vector<BrakeNumber> SlidingBrake::further_numbers() const
{
  Model model = model_;
  return friction_point_numbers(friction_of(model), "friction", [this](FrictionLaw law) {
    Model changed = model_;
    friction_of(changed) = std::move(law);
    return std::make_unique<SlidingBrake>(changed);
  });
}

std::unique_ptr<AutonomousMotion> SlidingBrake::motion(double speed) const
{
  return std::make_unique<ModelMotion<SlidingEquationsAt>>(
      SlidingEquationsAt{masses_, speed},
      ModelMotion<SlidingEquationsAt>::Properties{
          .size = size(),
          .n_switches = static_cast<Eigen::Index>(masses_.points.size()),
          .omega_highest = highest_frequency(masses_),
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
  return scale_of(masses_) * displacement * Eigen::VectorXd::Unit(size(), masses_.observed);
}

}  // namespace chladni::squeal
