#include "squeal/transient/integrator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "common/error.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/motion/generalised_alpha.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/stability/eigenvalues.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

using Complex = std::complex<double>;

/// Steps per period that are tried, each a factor of the square root of two finer.
constexpr int step_counts[] = {10, 14, 20, 28, 40, 56, 80, 112, 160, 224, 320, 448, 640};
/// Steps of the splitting for one period of the highest mode from which on "dormand-prince", with
/// its 12 evaluations for each of about 8 steps, needs no more evaluations than the splitting.
constexpr int splitting_steps_max = 48;
/// Of "exponential" and at least of "dormand-prince"; see docs/results/squeal_benchmarks.md.
constexpr int exponential_steps = 16;
constexpr int dormand_prince_steps = 6;
/// Growth error (1/s) on the reference disc of 20 steps of the splitting for a period of the
/// highest mode, or of 80 of the generalised-alpha method.
constexpr double reference_error = 1e-3;

/// K and C that the pads add to the modes near the sliding equilibrium, at t = 0.
struct LinearPads {
  Eigen::MatrixXd K;
  Eigen::MatrixXd C;
};

Eigen::MatrixXd shapes_on(const Disc& disc, const PointPair& point)
{
  return PointShapes(disc).at(point, 0.0);
}
Eigen::MatrixXd shapes_on(const InertialDisc& disc, const PointPair& point)
{
  return shapes_at(disc, point);
}

template <class AnyDisc>
LinearPads linear_pads(const AnyDisc& disc, const SquealOptions& options, double speed)
{
  const PadSystem system = pad_system(options, ring_places(disc));
  const Eigen::Index n = disc.n_modes() + system.n_modes();
  LinearPads pads{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  for (const PointPair& point : system.points) {
    const PairShapes S = pair_shapes(shapes_on(disc, point), system, point);
    const PairDerivatives d = pair_derivatives(point.contact, speed, static_cast<int>(S.cols()));
    pads.K -= S * d.D_a * S.transpose();
    pads.C -= S * d.D_p * S.transpose();
  }
  return pads;
}

/// Columns: where a step of the splitting takes the unit vectors of (diag(omega) a, p), as seen
/// from the inertial frame. Flow of the modes and rotation commute.
Eigen::MatrixXd splitting_step(const InertialDisc& without_pads, const SquealOptions& options,
                               double speed, double step)
{
  LinearPads pads = linear_pads(without_pads, options, speed);
  const InertialDisc disc = with_pads(without_pads, pad_system(options, ring_places(without_pads)));
  const Eigen::Index n = disc.n_modes();
  pads.C += 2.0 * speed * disc.G;
  const OscillatorFlow flow(disc.omega, disc.C, 0.5 * step);
  const auto half = [&](ModalState x) -> ModalState {
    flow.advance(x);
    return {turned(disc, x.q, 0.5 * step * speed), turned(disc, x.v, 0.5 * step * speed)};
  };
  const auto force = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v) -> Eigen::VectorXd {
    return -pads.K * q - pads.C * v;
  };
  Eigen::MatrixXd result(2 * n, 2 * n);
  for (Eigen::Index j = 0; j < 2 * n; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(2 * n, j);
    ModalState x = half({unit.head(n).cwiseQuotient(disc.omega), unit.tail(n)});
    x.v += step * force(x.q, x.v + 0.5 * step * force(x.q, x.v));
    x = half(x);
    result.col(j) << disc.omega.cwiseProduct(x.q), x.v;
  }
  return result;
}

/// What is overdamped has no growth to keep.
bool oscillates(const Complex& lambda)
{
  return std::abs(lambda.imag()) > std::abs(lambda.real());
}

/// Largest difference of the real parts of `exact` from those of the nearest of `discrete`.
double largest_error(const Eigen::VectorXcd& exact, const Eigen::VectorXcd& discrete)
{
  double largest = 0.0;
  for (const Complex& value : exact) {
    if (!oscillates(value)) continue;
    Eigen::Index nearest = 0;
    (discrete.array() - value).abs().minCoeff(&nearest);
    largest = std::max(largest, std::abs(discrete[nearest].real() - value.real()));
  }
  return largest;
}

/// The fewest steps that keep the growth error, the most that are tried when none does. For a disc
/// that is not axisymmetric, as many as the reference disc needs
/// (docs/results/squeal_benchmarks.md).
int steps_for(IntegratorKind kind, const std::optional<InertialDisc>& disc,
              const SquealOptions& options, const TransientCase& run)
{
  const double reference_steps = kind == IntegratorKind::splitting ? 20.0 : 80.0;
  for (const int steps : step_counts) {
    const double part = steps / reference_steps;
    const double error = disc ? growth_error_of(kind, *disc, options, run.speed, steps)
                              : reference_error / (part * part);
    if (error <= run.growth_error) return steps;
  }
  return *std::rbegin(step_counts);
}

/// Whether something decays faster than the highest mode oscillates, the rotation frozen.
bool is_stiff(const Disc& disc, const SquealOptions& options, double speed)
{
  const LinearPads pads = linear_pads(disc, options, speed);
  const FreeBrake brake = free_brake(disc, pad_system(options, ring_places(disc)), speed);
  const Eigen::Index n = brake.omega.size();
  const Eigen::MatrixXd omega = brake.omega.asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << Eigen::MatrixXd::Zero(n, n), omega,
      -omega - pads.K * brake.omega.cwiseInverse().asDiagonal(), -brake.C - pads.C;
  return -linear::real_eigenvalues(A).real().minCoeff() > brake.omega.maxCoeff();
}

/// Whether the start of a run may stop a pad on the disc, and friction then damps so fast that an
/// explicit step would chatter.
bool sticks(const Disc& disc, const std::optional<InertialDisc>& inertial,
            const SquealOptions& options, const TransientCase& run)
{
  const double sliding = run.speed * disc.rings.front().radius;
  const ModalState start = transient_start(disc, inertial, run, options.pads.front().angle);
  const auto rubs = [&](const PadPair& pad) {
    return pad.friction.value_or(options.friction).kinetic > 0.0;
  };
  if (std::ranges::none_of(options.pads, rubs) ||
      surface_speed(disc, options.thickness, start) < sliding)
    return false;
  return is_stiff(disc, with_friction_at_rest(options, disc, run.speed), 0.0);
}

/// Kind and steps of "auto".
IntegratorChoice cheapest(const Disc& disc, const std::optional<InertialDisc>& inertial,
                          const SquealOptions& options, const TransientCase& run)
{
  if (!run.is_constant()) {
    return {
        IntegratorKind::splitting, steps_for(IntegratorKind::splitting, inertial, options, run),
        0.0,
        run.speed_program.empty() ? "it follows a preload program" : "it follows a speed program"};
  }
  if (is_stiff(disc, options, run.speed)) {
    return {IntegratorKind::generalised_alpha, 0, 0.0,
            "the pads damp faster than the highest mode oscillates"};
  }
  if (sticks(disc, inertial, options, run)) {
    return {IntegratorKind::generalised_alpha, 0, 0.0,
            "pads may stick to the disc, and friction then damps faster than the highest mode "
            "oscillates"};
  }
  if (inertial) {
    return {IntegratorKind::exponential, 0, 0.0,
            "the disc is axisymmetric, so that small motions can be exact"};
  }
  const int steps = steps_for(IntegratorKind::splitting, inertial, options, run);
  if (steps <= splitting_steps_max) {
    return {IntegratorKind::splitting, steps, 0.0,
            fmt::format("{} steps for a period of the highest mode keep the growth rates to {:g} "
                        "1/s",
                        steps, run.growth_error)};
  }
  return {IntegratorKind::dormand_prince, 0, 0.0,
          fmt::format("splitting would take {} steps for a period of the highest mode to keep the "
                      "growth rates to {:g} 1/s",
                      steps, run.growth_error)};
}

}  // namespace

const char* name_of(IntegratorKind kind)
{
  switch (kind) {
    case IntegratorKind::automatic:
      return "auto";
    case IntegratorKind::splitting:
      return "splitting";
    case IntegratorKind::exponential:
      return "exponential";
    case IntegratorKind::dormand_prince:
      return "dormand-prince";
    case IntegratorKind::generalised_alpha:
      return "generalised-alpha";
  }
  return "";
}

double growth_error_of(IntegratorKind kind, const InertialDisc& disc, const SquealOptions& options,
                       double speed, int steps_per_period)
{
  const double step = 2.0 * pi / (disc.omega.maxCoeff() * steps_per_period);
  const Eigen::VectorXcd exact = linear::real_eigenvalues(state_matrix(disc, options, speed));
  if (kind == IntegratorKind::splitting) {
    const Eigen::ArrayXcd mu =
        linear::real_eigenvalues(splitting_step(disc, options, speed, step)).array();
    return largest_error(exact, mu.log() / step);
  }
  if (kind != IntegratorKind::generalised_alpha) return 0.0;
  double largest = 0.0;
  for (const Complex& lambda : exact) {
    if (!oscillates(lambda)) continue;
    // The amplification of x' = lambda x by the trapezoidal rule, and the numerical damping.
    const Complex half = 0.5 * step * lambda;
    const Complex discrete = std::log((1.0 + half) / (1.0 - half)) / step;
    const double numerical = damping_of_step(std::abs(lambda.imag()), step);
    largest = std::max(largest, std::abs(discrete.real() - lambda.real()) + numerical);
  }
  return largest;
}

IntegratorChoice choose_integrator(const Disc& disc, const std::optional<InertialDisc>& inertial,
                                   const SquealOptions& options, const TransientCase& run)
{
  if (run.integrator == IntegratorKind::exponential && !inertial) {
    throw Error(
        "transient: the integrator \"exponential\" needs an axisymmetric disc with both modes of "
        "each pair; take \"auto\" or \"splitting\"");
  }
  if (!run.is_constant() && run.integrator != IntegratorKind::automatic &&
      run.integrator != IntegratorKind::splitting)
    throw Error(
        fmt::format("transient: the integrator \"{}\" needs a constant speed and preload; a "
                    "speed_program or preload_program needs \"splitting\"",
                    name_of(run.integrator)));
  IntegratorChoice choice{run.integrator, 0, 0.0, ""};
  if (run.integrator == IntegratorKind::automatic) choice = cheapest(disc, inertial, options, run);
  if (run.steps_per_period)
    choice.steps_per_period = *run.steps_per_period;
  else if (choice.kind == IntegratorKind::exponential)
    choice.steps_per_period = exponential_steps;
  else if (choice.kind == IntegratorKind::dormand_prince)
    choice.steps_per_period = dormand_prince_steps;
  else if (choice.steps_per_period == 0)
    choice.steps_per_period = steps_for(choice.kind, inertial, options, run);

  const double omega_h = 2.0 * pi / choice.steps_per_period;
  // A step of the trapezoidal rule errs by (omega h)^3 / 12; an error of order 8 that all steps
  // commit in the same direction adds up to growth_error in a second.
  choice.tolerance = choice.kind == IntegratorKind::generalised_alpha
                         ? omega_h * omega_h * omega_h / 12.0
                         : run.growth_error * omega_h / disc.omega.maxCoeff();
  return choice;
}

namespace {

/// eps over the speed of sliding. The creep of a pad that sticks is an error of first order in it.
constexpr double creep = 1e-3;

/// sum over the harmonics of the amplitude of each mode, a bound of its largest value.
Eigen::ArrayXd amplitudes(const Harmonics& f)
{
  return (f.cosine.cwiseAbs2() + f.sine.cwiseAbs2()).cwiseSqrt().colwise().sum().transpose();
}

}  // namespace

SquealOptions with_friction_at_rest(SquealOptions options, const Disc& disc, double speed)
{
  const auto regularise = [&](FrictionLaw& law) {
    if (law.regularisation == 0.0)
      law.regularisation = creep * std::abs(speed) * disc.rings.front().radius;
  };
  regularise(options.friction);
  for (PadPair& pad : options.pads)
    if (pad.friction) regularise(*pad.friction);
  return options;
}

double surface_speed(const Disc& disc, double thickness, const ModalState& start)
{
  const DiscRing& ring = disc.rings.front();
  const Eigen::ArrayXd slopes =
      (amplitudes(ring.W_r).square() + amplitudes(ring.W_t).square()).sqrt();
  const Eigen::ArrayXd rates =
      (disc.omega.cwiseProduct(start.q).cwiseAbs2() + start.v.cwiseAbs2()).cwiseSqrt().array();
  const double bending = 0.5 * thickness * (slopes * rates).sum();
  if (ring.V_r.cosine.size() == 0) return bending;
  const Eigen::ArrayXd in_plane =
      (amplitudes(ring.V_r).square() + amplitudes(ring.V_t).square()).sqrt();
  return bending + (in_plane * rates).sum();
}

namespace {

/// a_cos = a_sin in the first pair, turned so that the crest of the cosine is at `angle`; at rest
/// in the inertial frame, i.e. a' = 0, p = Omega D a. Pairs in the plane do not move the pads.
ModalState start_in_first_pair(const InertialDisc& disc, const TransientCase& run, double angle)
{
  Eigen::VectorXd a = Eigen::VectorXd::Zero(disc.n_modes());
  const Eigen::VectorXd& U = disc.rings.front().U;
  const double still = 1e-3 * U.cwiseAbs().maxCoeff();
  Eigen::Index first = 0;
  for (Eigen::Index i = 1; i < disc.n_modes(); ++i) {
    if (disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 && std::abs(U[i]) > still &&
        (disc.nodal_diameters[static_cast<std::size_t>(first)] == 0 ||
         std::abs(U[first]) <= still || disc.omega[i] < disc.omega[first]))
      first = i;
  }
  const bool pair = disc.nodal_diameters[static_cast<std::size_t>(first)] > 0;
  a.segment(first, pair ? 2 : 1).setConstant(run.initial_pad_displacement / U[first]);
  const Eigen::VectorXd at_pad = turned(disc, a, angle);
  return {disc.R * at_pad, disc.R * (run.speed * disc.D * at_pad)};
}

}  // namespace

ModalState transient_start(const Disc& disc, const std::optional<InertialDisc>& inertial,
                           const TransientCase& run, double angle)
{
  if (inertial) return start_in_first_pair(*inertial, run, angle);
  const Eigen::VectorXd W = shapes_at(disc, angle).W;
  return {W * (run.initial_pad_displacement / W.squaredNorm()),
          Eigen::VectorXd::Zero(disc.n_modes())};
}

}  // namespace chladni::squeal
