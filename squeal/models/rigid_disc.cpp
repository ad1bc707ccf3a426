#include "squeal/models/rigid_disc.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/model_motion.hpp"
#include "squeal/models/parameters.hpp"
#include "squeal/numerics.hpp"

namespace chladni::squeal {

namespace {

/// Axes of the disc that do not spin with it, in inertial components: b_3 is its normal.
template <class Scalar>
struct Frame {
  Eigen::Vector3<Scalar> b_1, b_2, b_3;
  Eigen::Vector3<Scalar> omega;  ///< of the disc, rad/s
  Scalar s_1, c_1, s_2, c_2;
};

template <class Scalar>
Frame<Scalar> frame_of(const RigidMotion<Scalar>& motion)
{
  using std::cos, std::sin;
  const Scalar s_1 = sin(motion.q[0]), c_1 = cos(motion.q[0]);
  const Scalar s_2 = sin(motion.q[1]), c_2 = cos(motion.q[1]);
  const Scalar zero(0.0);
  const Eigen::Vector3<Scalar> b_1{c_2, s_1 * s_2, -c_1 * s_2}, b_2{zero, c_1, s_1},
      b_3{s_2, -s_1 * c_2, c_1 * c_2};
  const Eigen::Vector3<Scalar> e_x{Scalar(1.0), zero, zero};
  return {b_1, b_2, b_3, motion.q_dot[0] * e_x + motion.q_dot[1] * b_2 + motion.spin * b_3,
          s_1, c_1, s_2, c_2};
}

/// Without the conjugation of Eigen's dot product, which has no derivative.
template <class Scalar>
Scalar dot(const Eigen::Vector3<Scalar>& a, const Eigen::Vector3<Scalar>& b)
{
  return a.cwiseProduct(b).sum();
}

template <class Scalar>
Eigen::Vector3<Scalar> cross(const Eigen::Vector3<Scalar>& a, const Eigen::Vector3<Scalar>& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// z = (sigma h / 2 - b_3x x_p - b_3y y_p) / b_3z,   S = N_0 + sigma (k x + k_3 x^3 + d z'),
/// x = z - sigma h / 2,
/// N = S / (b_3z + sigma g mu t_z),   F = -sigma N b_3 - mu g N t
/// @param law  yields S and g of the pad from its force if it could pull
template <class Scalar, class Law>
RigidPad<Scalar> pad_of(const RigidDisc& disc, const Frame<Scalar>& frame, double sigma,
                        const Law& law)
{
  using std::sqrt;
  const double half = 0.5 * sigma * disc.thickness;
  const Scalar z = (half + disc.radius * frame.b_3[1]) / frame.b_3[2];
  const Eigen::Vector3<Scalar> r{Scalar(0.0), Scalar(-disc.radius), z};
  const Eigen::Vector3<Scalar> v = cross<Scalar>(frame.omega, r);
  const Scalar z_dot = dot<Scalar>(frame.b_3, v) / frame.b_3[2];
  const Eigen::Vector3<Scalar> v_r = v - z_dot * Eigen::Vector3<Scalar>::UnitZ();
  const Scalar slip_squared = dot<Scalar>(v_r, v_r);
  const Scalar v_reg = regularised_speed(disc.friction, slip_squared);

  const Scalar pad_force =
      disc.preload + sigma * (force(disc.spring, Scalar(z - half)) + disc.damping * z_dot);
  const auto [S, g] = law(pad_force);
  const Scalar g_mu_by_v = g * friction_coefficient(disc.friction, v_reg) / v_reg;
  const Scalar N = S / (frame.b_3[2] + sigma * g_mu_by_v * v_r[2]);
  const Eigen::Vector3<Scalar> F = (-sigma * N) * frame.b_3 - (g_mu_by_v * N) * v_r;
  return {z, z_dot, S, pad_force, N, sqrt(slip_squared), F};
}

/// Moment of the force of a pad about the centre of the disc.
template <class Scalar>
Eigen::Vector3<Scalar> moment_of(const RigidDisc& disc, const RigidPad<Scalar>& pad)
{
  return cross<Scalar>({Scalar(0.0), Scalar(-disc.radius), pad.z}, pad.F);
}

/// What is left of the equations of motion along b_1, b_2, b_3 without accelerations and drive:
/// moments of pads, springs and dampers, and the gyroscopic terms.
template <class Scalar>
Eigen::Vector3<Scalar> moments(const RigidDisc& disc, const RigidMotion<Scalar>& motion,
                               const Frame<Scalar>& frame, const Eigen::Vector3<Scalar>& M_pads)
{
  const Eigen::Vector2<Scalar>&q = motion.q, &u = motion.q_dot;
  const Scalar s_2 = frame.s_2, c_2 = frame.c_2, omega_3 = u[0] * s_2 + motion.spin;
  return {dot<Scalar>(M_pads, frame.b_1) - (disc.k_t * q[0] + disc.d_t * u[0]) / c_2 +
              2.0 * disc.Theta * s_2 * u[0] * u[1] - disc.Phi * u[1] * omega_3,
          dot<Scalar>(M_pads, frame.b_2) - (disc.k_t * q[1] + disc.d_t * u[1]) -
              disc.Theta * s_2 * c_2 * u[0] * u[0] + disc.Phi * c_2 * u[0] * omega_3,
          dot<Scalar>(M_pads, frame.b_3) - disc.Phi * c_2 * u[0] * u[1]};
}

template <class Scalar>
RigidAcceleration<Scalar> acceleration_under(const RigidDisc& disc,
                                             const RigidMotion<Scalar>& motion, Drive drive,
                                             const std::array<RigidPad<Scalar>, 2>& pads)
{
  const Frame<Scalar> frame = frame_of(motion);
  const auto& [up, lo] = pads;
  // Theta c_2 q_1''          = rhs_1 + M_A e_z.b_1
  // Theta q_2''              = rhs_2 + M_A e_z.b_2
  // Phi (spin' + s_2 q_1'')  = rhs_3 + M_A e_z.b_3
  Eigen::Vector3<Scalar> rhs =
      moments<Scalar>(disc, motion, frame, moment_of(disc, up) + moment_of(disc, lo));
  const Eigen::Vector3<Scalar> e_z{frame.b_1[2], frame.b_2[2], frame.b_3[2]};
  Eigen::Matrix3<Scalar> A = Eigen::Matrix3<Scalar>::Zero();  // of (q_1'', q_2'', M_A or spin')
  A(0, 0) = disc.Theta * frame.c_2;
  A(1, 1) = disc.Theta;
  A(2, 0) = disc.Phi * frame.s_2;
  const Scalar constant_moment(2.0 * disc.friction.kinetic * disc.radius * disc.preload);
  const bool by_speed = drive == Drive::speed;
  if (by_speed) {
    A.col(2) = -e_z;
  } else {
    A(2, 2) = disc.Phi;
    rhs += constant_moment * e_z;
  }
  const Eigen::Vector3<Scalar> x = A.partialPivLu().solve(rhs);
  return {x.template head<2>(), by_speed ? Scalar(0.0) : x[2], by_speed ? x[2] : constant_moment,
          up, lo};
}

}  // namespace

template <class Scalar>
RigidAcceleration<Scalar> accelerate(const RigidDisc& disc, const RigidMotion<Scalar>& motion,
                                     Drive drive)
{
  const auto law = [&](const Scalar& S) { return axial_force<Scalar>(disc.law, S); };
  const Frame<Scalar> frame = frame_of(motion);
  return acceleration_under<Scalar>(
      disc, motion, drive, {pad_of(disc, frame, 1.0, law), pad_of(disc, frame, -1.0, law)});
}

template <class Scalar>
RigidAcceleration<Scalar> accelerate_on_branches(const RigidDisc& disc,
                                                 const RigidMotion<Scalar>& motion, Drive drive,
                                                 const std::array<double, 2>& branches)
{
  const auto on = [](double g) {
    return [g](const Scalar& S) { return AxialForce<Scalar>{g == 0.0 ? Scalar(0.0) : S, g}; };
  };
  const Frame<Scalar> frame = frame_of(motion);
  return acceleration_under<Scalar>(
      disc, motion, drive,
      {pad_of(disc, frame, 1.0, on(branches[0])), pad_of(disc, frame, -1.0, on(branches[1]))});
}

template RigidAcceleration<double> accelerate_on_branches(const RigidDisc&,
                                                          const RigidMotion<double>&, Drive,
                                                          const std::array<double, 2>&);
template RigidAcceleration<std::complex<double>> accelerate_on_branches(
    const RigidDisc&, const RigidMotion<std::complex<double>>&, Drive,
    const std::array<double, 2>&);
template RigidAcceleration<double> accelerate(const RigidDisc&, const RigidMotion<double>&, Drive);
template RigidAcceleration<std::complex<double>> accelerate(
    const RigidDisc&, const RigidMotion<std::complex<double>>&, Drive);

RigidMatrices rigid_disc_matrices(const RigidDisc& disc, double speed)
{
  const double mu = disc.friction.kinetic, N_0 = disc.preload, h = disc.thickness,
               r_0 = disc.radius;
  const double k = disc.spring.linear, d = disc.damping;
  const double slip = 0.5 * mu * N_0 * h * h / r_0;
  RigidMatrices matrices;
  matrices.M = disc.Theta * Eigen::Matrix2d::Identity();
  matrices.C << slip / speed + 2.0 * d * r_0 * r_0 + disc.d_t, disc.Phi * speed,
      -disc.Phi * speed - mu * d * h * r_0, disc.d_t;
  matrices.K << disc.k_t + 2.0 * k * r_0 * r_0 + N_0 * h, slip,
      -mu * (k * h * r_0 + 2.0 * N_0 * r_0), disc.k_t + (1.0 + mu * mu) * N_0 * h;
  return matrices;
}

RigidMatrices linearised(const RigidDisc& disc, Drive drive, double speed)
{
  using Complex = std::complex<double>;
  constexpr double step = 1e-30;  // f(i h) / h has no difference in it
  RigidMatrices matrices;
  matrices.M = disc.Theta * Eigen::Matrix2d::Identity();
  for (int j = 0; j < 2; ++j) {
    RigidMotion<Complex> tilted{Eigen::Vector2cd::Zero(), Eigen::Vector2cd::Zero(), speed};
    RigidMotion<Complex> tilting = tilted;
    tilted.q[j] = tilting.q_dot[j] = Complex(0.0, step);
    matrices.K.col(j) = -disc.Theta / step * accelerate(disc, tilted, drive).q_ddot.imag();
    matrices.C.col(j) = -disc.Theta / step * accelerate(disc, tilting, drive).q_ddot.imag();
  }
  return matrices;
}

Eigen::MatrixXd first_order(const RigidMatrices& matrices)
{
  // x = (omega q, q') with a frequency of the system keeps all entries of one size.
  const double omega = std::sqrt(matrices.K.trace() / matrices.M.trace());
  const Eigen::Matrix2d by_M = matrices.M.inverse();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A.topRightCorner<2, 2>() = omega * Eigen::Matrix2d::Identity();
  A.bottomLeftCorner<2, 2>() = -by_M * matrices.K / omega;
  A.bottomRightCorner<2, 2>() = -by_M * matrices.C;
  return A;
}

Eigen::Vector2cd eigenvalues(const RigidMatrices& matrices)
{
  Eigen::Vector4cd lambda = first_order(matrices).eigenvalues();
  std::ranges::sort(lambda, [](const auto& x, const auto& y) { return x.imag() < y.imag(); });
  return lambda.tail<2>();
}

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
ContactResult<double> linear_rigid_pads(const RigidDisc& disc, Drive drive,
                                        const Eigen::VectorXd& x, double speed)
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

Places places_in_disc(RigidDisc& disc)
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
  for (const auto& [name, place] : places_in_disc(changed.disc))
    if (name == parameter.name && parameter.pad <= 1) at = place;
  set_parameter(at, parameter, value);
  return std::make_unique<RigidDiscBrake>(changed);
}

std::vector<ParameterValue> RigidDiscBrake::parameters() const
{
  RigidDisc disc = study_.disc;
  std::vector<ParameterValue> values = friction_parameters(disc.friction);
  for (const auto& [name, place] : places_in_disc(disc)) {
    const bool is_of_pad = name == "preload" || name == "stiffness" || name == "damping";
    if (name != "friction") values.push_back({{name, is_of_pad ? 1 : 0}, *place});
  }
  return values;
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
             ? linear_rigid_pads(study_.disc, study_.drive, x, speed)
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
