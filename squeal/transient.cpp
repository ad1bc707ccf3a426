#include "squeal/transient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/contact_kick.hpp"
#include "squeal/growth_rate.hpp"
#include "squeal/inertial_frame.hpp"
#include "squeal/integrator_choice.hpp"
#include "squeal/recorder.hpp"
#include "squeal/resampler.hpp"
#include "squeal/speed_program.hpp"
#include "squeal/stability.hpp"
#include "squeal/transient_plan.hpp"
#include "squeal/transient_start.hpp"
#include "squeal/transient_steps.hpp"

namespace chladni::squeal {
namespace {

void check_speed_program(const SquealOptions& options, const TransientCase& run)
{
  const bool stops = std::any_of(run.speed_program.begin(), run.speed_program.end(),
                                 [](const SpeedPoint& point) { return !(point.speed > 0.0); });
  if (stops && !(options.slip_regularisation > 0.0))
    throw Error(
        "transient: the speed program comes to rest, where friction has no direction; give "
        "friction a regularisation, e.g. friction = { kinetic = 0.6, regularisation = 1e-3 }");
}

/// Samples of one period of the highest mode.
int sampling_of(const IntegratorChoice& choice)
{
  const bool fixed =
      choice.kind == IntegratorKind::splitting || choice.kind == IntegratorKind::exponential;
  return fixed ? choice.steps_per_period : samples_per_period;
}

/// Of the modes; the highest also of light plates beside the springs of their linings, from the
/// symmetric part of the stiffness in one position of the disc.
FrequencyRange frequencies_of(const Disc& disc, const SquealOptions& options, double speed)
{
  const ContactKick kick(disc, options, speed);
  const FreeBrake brake = free_brake(disc, kick.pads(), speed);
  FrequencyRange range{.lowest = disc.omega.minCoeff(), .highest = brake.omega.maxCoeff()};
  if (kick.pads().n_modes() == 0) return range;
  const Eigen::MatrixXd K =
      brake.omega.cwiseAbs2().asDiagonal().toDenseMatrix() + kick.contact_stiffness();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
      Eigen::MatrixXd(0.5 * (K + K.transpose())), Eigen::EigenvaluesOnly);
  range.highest = std::max(range.highest, std::sqrt(modes.eigenvalues().maxCoeff()));
  return range;
}

double rest_compression(const SquealOptions& options)
{
  return options.pads.front().preload / options.pads.front().stiffness;
}

/// q in the inertial frame but along the modes of the body.
Eigen::VectorXd in_inertial_frame(const InertialDisc& inertial, const Eigen::VectorXd& q,
                                  double angle)
{
  return inertial.R * turned(inertial, inertial.R.transpose() * q, angle);
}

/// The states that a run keeps, by sample.
class StateRecorder {
 public:
  StateRecorder(const Disc& disc, const std::optional<InertialDisc>& inertial,
                const RecordingPlan& plan, const TransientCase& run)
      : omega_(disc.omega), inertial_(inertial), plan_(plan), run_(run)
  {
    const auto n_kept = static_cast<Eigen::Index>((plan.n_steps - 1) / plan.every + 1);
    modes_.q.resize(disc.n_modes(), n_kept);
    modes_.v.resize(disc.n_modes(), n_kept);
    if (inertial) tail_a_.resize(disc.n_modes(), static_cast<Eigen::Index>(plan.n_tail));
  }

  void add(std::int64_t i, double t, const TransientSteps& steps)
  {
    const bool in_tail = inertial_ && i >= plan_.n_steps - plan_.n_tail;
    if (!in_tail && i % plan_.every != 0) return;
    const ModalState x = steps.state();
    if (in_tail)
      tail_a_.col(n_tail_++) = in_inertial_frame(*inertial_, x.q, turn_at(run_, t).angle);
    if (i % plan_.every != 0) return;
    const auto column = static_cast<Eigen::Index>(modes_.energy.size());
    modes_.q.col(column) = x.q;
    modes_.v.col(column) = x.v;
    modes_.energy.push_back(0.5 * (x.v.squaredNorm() + omega_.cwiseProduct(x.q).squaredNorm()));
  }

  /// What was collected.
  ModalHistory modes() const
  {
    const auto n = static_cast<Eigen::Index>(modes_.energy.size());
    return {modes_.q.leftCols(n), modes_.v.leftCols(n), modes_.energy};
  }
  Eigen::MatrixXd tail_a() const { return tail_a_.leftCols(n_tail_); }

 private:
  Eigen::VectorXd omega_;
  const std::optional<InertialDisc>& inertial_;
  RecordingPlan plan_;
  const TransientCase& run_;
  ModalHistory modes_;
  Eigen::MatrixXd tail_a_;
  Eigen::Index n_tail_ = 0;
};

/// Sliding so slow that its direction turns within a step of an explicit kick, m/s, without
/// regularisation, and with it in multiples of that.
constexpr double slow_sliding = 1e-2, slow_multiple = 10.0;

std::string warning_of_sliding(const Transient& run, const SquealOptions& options)
{
  const double eps = options.slip_regularisation;
  const double limit = eps > 0.0 ? slow_multiple * eps : slow_sliding;
  if (run.slip_speed_min >= limit || options.friction == 0.0 ||
      run.integrator == name_of(IntegratorKind::generalised_alpha))
    return {};
  return fmt::format(
      "sliding fell to {:.2g} m/s, {}; compare with integrator = \"generalised-alpha\"",
      run.slip_speed_min,
      eps > 0.0 ? "where the regularisation of friction counts"
                : "where the direction of friction turns at once: give friction a regularisation");
}

std::string warning_of(const Transient& run, const Disc& disc, const SquealOptions& options)
{
  const std::string sliding = warning_of_sliding(run, options);
  const auto inertial = find_inertial_disc(disc);
  if (!run.growth_rate || !inertial) return sliding;
  const std::string growth = warning_of_growth(
      *run.growth_rate, least_stable_eigenvalue(*inertial, options, run.speed).real());
  return sliding.empty() || growth.empty() ? sliding + growth : sliding + "; " + growth;
}

bool is_finite(const std::vector<ContactResult<double>>& contacts)
{
  return std::all_of(contacts.begin(), contacts.end(), [](const ContactResult<double>& pair) {
    return std::isfinite(pair.upper.z) && std::isfinite(pair.upper.z_dot) &&
           std::isfinite(pair.upper.N) && std::isfinite(pair.lower.N);
  });
}

}  // namespace

Transient transient(const Disc& disc, const SquealOptions& options, const TransientCase& run,
                    const Progress& progress)
{
  if (options.pads.empty()) throw Error("transient: no pads");
  check_transient(run, disc.omega.maxCoeff());
  check_speed_program(options, run);
  const std::optional<InertialDisc> inertial = find_inertial_disc(disc);
  const IntegratorChoice choice = choose_integrator(disc, inertial, options, run);
  const RecordingPlan plan =
      recording_plan(run, frequencies_of(disc, options, run.speed), sampling_of(choice));
  const auto steps =
      transient_steps(disc, options, run, choice, plan.step,
                      transient_start(disc, inertial, run, options.pads.front().angle));
  Recorder recorder(plan, 0.5 * options.thickness);
  StateRecorder states(disc, inertial, plan, run);
  std::optional<Resampler> sound;
  if (options.sound) sound.emplace(plan.step, options.sound->rate_Hz);
  bool finite = true;
  for (std::int64_t i = 0; i < plan.n_steps && finite; ++i) {
    const double t = (double(i) + 0.5) * plan.step;
    const auto& contacts = steps->next();
    finite = is_finite(contacts);
    if (finite) {
      recorder.add(i, t, contacts);
      states.add(i, t, *steps);
      if (sound) sound->add(contacts.front().upper.z_dot);
    }
    if (progress && i % plan.window == 0) progress(double(i) / double(plan.n_steps));
  }

  Transient result = recorder.transient();
  result.speed = run.speed;
  result.finished = finite;
  result.integrator = name_of(choice.kind);
  result.integrator_reason = choice.reason;
  result.n_steps = steps->n_steps();
  result.n_contact_evaluations = steps->n_contact_evaluations();
  result.events = steps->events();
  if (run.speed_program.empty())
    result.growth_rate = growth_rate(result.envelope, linear_part * rest_compression(options));
  else
    result.speed = turn_at(run, run.duration).speed;
  result.modes = states.modes();
  result.tail_a = states.tail_a();
  result.warning = warning_of(result, disc, options);
  if (sound) {
    sound->finish();
    result.sound = sound->samples();
  }
  return result;
}

Growth growth(const Disc& disc, const SquealOptions& options, double speed, double duration)
{
  const Transient run =
      transient(disc, options, growth_case(speed, duration, rest_compression(options)));
  Growth result{speed, run.envelope, required_growth_rate(run, duration, disc.omega.minCoeff()),
                std::nullopt};
  if (const auto inertial = find_inertial_disc(disc))
    result.eigenvalue_rate = least_stable_eigenvalue(*inertial, options, speed).real();
  return result;
}

std::string divergence_of(const Transient& run)
{
  const double t = run.history.t.empty() ? 0.0 : run.history.t.back();
  return fmt::format(
      "the motion diverged after {:.3g} s; damping or the contact law do not bound it", t);
}

}  // namespace chladni::squeal
