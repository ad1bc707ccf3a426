#include "squeal/transient/prepared_transient.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/real_eigenvalues.hpp"
#include "squeal/brake/friction_range.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/contact_kick.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/lumped_steps.hpp"
#include "squeal/transient/transient_start.hpp"

namespace chladni::squeal {
namespace {

/// Each point of the programs lies in the tables of friction.
void check_tables(const PadSystem& pads, const TransientCase& run)
{
  std::vector<double> speeds{run.speed}, preloads{1.0};
  for (const SpeedPoint& point : run.speed_program) speeds.push_back(point.speed);
  for (const PreloadPoint& point : run.preload_program) preloads.push_back(point.factor);
  if (!run.preload_program.empty()) preloads.erase(preloads.begin());
  for (const PointPair& point : pads.points)
    for (const double speed : speeds)
      for (const double preload : preloads) {
        PadContact contact = point.contact;
        contact.preload *= preload;
        require_in_table(contact, speed);
      }
}

void check_speed_program(const FrictionLaw& friction, const TransientCase& run)
{
  const bool stops = std::ranges::any_of(
      run.speed_program, [](const SpeedPoint& point) { return !(point.speed > 0.0); });
  if (stops && !(friction.regularisation > 0.0)) {
    throw Error(
        "transient: the speed program comes to rest, where friction has no direction; give "
        "friction a regularisation, e.g. friction = { kinetic = 0.6, regularisation = 1e-3 }");
  }
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

/// Of the eigenvalues about the sliding equilibrium.
FrequencyRange frequencies_of(const Brake& brake, double speed)
{
  const Eigen::VectorXcd lambda = linear::real_eigenvalues(brake.state_matrix(speed));
  const double highest = lambda.cwiseAbs().maxCoeff();
  double lowest = highest;
  for (const std::complex<double>& value : lambda)
    if (value.imag() > 0.0) lowest = std::min(lowest, value.imag());
  return {.lowest = lowest, .highest = highest};
}

PreparedTransient prepared_with_body(const FlexibleDisc& brake, const TransientCase& run)
{
  const Disc& disc = brake.disc();
  const SquealOptions& options = brake.options();
  if (options.pads.empty()) throw Error("transient: no pads");
  check_transient(run, disc.omega.maxCoeff());
  check_speed_program(options.friction, run);
  for (const PadPair& pad : options.pads)
    if (pad.friction) check_speed_program(*pad.friction, run);
  check_tables(pad_system(options, ring_places(disc)), run);
  const std::optional<InertialDisc>& inertial = brake.find_inertial();
  const IntegratorChoice choice = choose_integrator(disc, inertial, options, run);
  const RecordingPlan plan =
      recording_plan(run, frequencies_of(disc, options, run.speed), sampling_of(choice));
  auto steps = transient_steps(disc, options, run, choice, plan.step,
                               transient_start(disc, inertial, run, options.pads.front().angle));
  const ModalSteps* const modal = steps.get();
  return {.plan = plan,
          .integrator = name_of(choice.kind),
          .reason = choice.reason,
          .rest_height = 0.5 * options.thickness,
          .first_sample = 0.5,
          .steps = std::move(steps),
          .states = SnapshotRecorder(disc, inertial, plan, run),
          .modal = modal};
}

PreparedTransient prepared_lumped(const LumpedBrake& brake, const TransientCase& run)
{
  if (run.integrator != IntegratorKind::automatic &&
      run.integrator != IntegratorKind::dormand_prince)
    throw Error(
        "transient: a model without a body has the integrator \"dormand-prince\" alone; leave "
        "integrator out");
  if (!run.is_constant()) {
    throw Error(
        "transient: a model without a body turns at a constant speed and preload; leave "
        "speed_program and preload_program out");
  }
  const RecordingPlan plan = recording_plan(run, frequencies_of(brake, run.speed),
                                            run.steps_per_period.value_or(lumped_steps_per_period));
  return {.plan = plan,
          .integrator = name_of(IntegratorKind::dormand_prince),
          .reason = "of order 8 with fixed steps, for models without a body",
          .rest_height = brake.rest_height(),
          .first_sample = 0.0,
          .steps = std::make_unique<LumpedSteps>(brake, run, plan.step),
          .states = std::nullopt,
          .modal = nullptr};
}

}  // namespace

PreparedTransient prepared_transient(const Brake& brake, const TransientCase& run)
{
  if (const FlexibleDisc* body = brake.body()) return prepared_with_body(*body, run);
  if (const LumpedBrake* lumped = brake.lumped()) return prepared_lumped(*lumped, run);
  throw Error(
      "transient: this brake has neither a modal body nor equations of first order; look for its "
      "limit cycles directly");
}

double lowest_frequency(const Brake& brake, double speed)
{
  if (const FlexibleDisc* body = brake.body()) return body->disc().omega.minCoeff();
  return frequencies_of(brake, speed).lowest;
}

}  // namespace chladni::squeal
