#include "squeal/transient.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/error.hpp"
#include "squeal/contact_kick.hpp"
#include "squeal/growth_rate.hpp"
#include "squeal/inertial_frame.hpp"
#include "squeal/oscillator_flow.hpp"
#include "squeal/recorder.hpp"
#include "squeal/stability.hpp"
#include "squeal/transient_plan.hpp"

namespace chladni::squeal {
namespace {

/// a_cos = a_sin in the first pair, turned so that the crest of the cosine is at `angle`; at rest
/// in the inertial frame, i.e. a' = 0, p = Omega D a.
ModalState start_in_first_pair(const InertialDisc& disc, const TransientCase& run, double angle)
{
  Eigen::VectorXd a = Eigen::VectorXd::Zero(disc.n_modes());
  Eigen::Index first = 0;
  for (Eigen::Index i = 1; i < disc.n_modes(); ++i)
    if (disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 &&
        (disc.nodal_diameters[static_cast<std::size_t>(first)] == 0 ||
         disc.omega[i] < disc.omega[first]))
      first = i;
  const bool pair = disc.nodal_diameters[static_cast<std::size_t>(first)] > 0;
  a.segment(first, pair ? 2 : 1).setConstant(run.initial_pad_displacement / disc.U[first]);
  const Eigen::VectorXd at_pad = turned(disc, a, angle);
  return {disc.R * at_pad, disc.R * (run.speed * disc.D * at_pad)};
}

ModalState initial_state(const Disc& disc, const std::optional<InertialDisc>& inertial,
                         const TransientCase& run, double angle)
{
  if (inertial) return start_in_first_pair(*inertial, run, angle);
  const Eigen::VectorXd W = shapes_at(disc, angle).W;
  return {W * (run.initial_pad_displacement / W.squaredNorm()),
          Eigen::VectorXd::Zero(disc.n_modes())};
}

/// Modes of the disc, then those of the pads, without contact.
struct FreeBrake {
  Eigen::VectorXd omega;  ///< rad/s
  Eigen::MatrixXd C;      ///< 1/s
};

FreeBrake free_brake(const Disc& disc, const PadSystem& pads)
{
  const Eigen::Index n = disc.n_modes(), m = pads.n_modes();
  FreeBrake brake{Eigen::VectorXd(n + m), Eigen::MatrixXd::Zero(n + m, n + m)};
  brake.omega << disc.omega, pads.omega;
  brake.C.topLeftCorner(n, n) = disc.C;
  brake.C.bottomRightCorner(m, m) = pads.C;
  return brake;
}

/// Beside the springs between disc and plates a light plate is fast: the highest frequency is then
/// that of the symmetric part of the stiffness, at one position of the disc.
FrequencyRange frequencies_of(const Disc& disc, const FreeBrake& free, const ContactKick& kick)
{
  double highest = free.omega.maxCoeff();
  if (kick.pads().n_modes() > 0) {
    const Eigen::MatrixXd K =
        free.omega.cwiseAbs2().asDiagonal().toDenseMatrix() + kick.contact_stiffness();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(0.5 * (K + K.transpose()),
                                                               Eigen::EigenvaluesOnly);
    highest = std::max(highest, std::sqrt(modes.eigenvalues().maxCoeff()));
  }
  return {.lowest = disc.omega.minCoeff(), .highest = highest};
}

ModalState with_pads_at_rest(ModalState x, Eigen::Index n)
{
  x.q.conservativeResizeLike(Eigen::VectorXd::Zero(n));
  x.v.conservativeResizeLike(Eigen::VectorXd::Zero(n));
  return x;
}

double rest_compression(const SquealOptions& options)
{
  return options.pads.front().preload / options.pads.front().stiffness;
}

/// q of the tail, column by column, in the inertial frame but along the modes of the body.
Eigen::MatrixXd in_inertial_frame(const InertialDisc& inertial, const Eigen::MatrixXd& q,
                                  const std::vector<double>& t, double speed)
{
  Eigen::MatrixXd a(q.rows(), static_cast<Eigen::Index>(t.size()));
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    a.col(j) = inertial.R * turned(inertial, inertial.R.transpose() * q.col(j),
                                   speed * t[static_cast<std::size_t>(j)]);
  return a;
}

}  // namespace

Transient transient(const Disc& disc, const SquealOptions& options, const TransientCase& run,
                    const Progress& progress)
{
  if (options.pads.empty()) throw Error("transient: no pads");
  const std::optional<InertialDisc> inertial = find_inertial_disc(disc);
  ContactKick kick(disc, options, run.speed);
  const FreeBrake free = free_brake(disc, kick.pads());
  const RecordingPlan plan = recording_plan(run, frequencies_of(disc, free, kick));
  const OscillatorFlow whole_step(free.omega, free.C, plan.step);
  Recorder recorder(plan, 0.5 * options.thickness);
  Eigen::MatrixXd tail_q(disc.n_modes(), plan.n_tail);

  ModalState x = with_pads_at_rest(initial_state(disc, inertial, run, options.pads.front().angle),
                                   free.omega.size());
  OscillatorFlow(free.omega, free.C, 0.5 * plan.step).advance(x);
  bool finite = true;
  for (std::int64_t i = 0; i < plan.n_steps && finite; ++i) {
    // The two half flows between two kicks are one; all results are those of the kick, which
    // the splitting leaves symmetric in time.
    const double t = (double(i) + 0.5) * plan.step;
    if (recorder.in_tail(i))
      tail_q.col(i - (plan.n_steps - plan.n_tail)) = x.q.head(disc.n_modes());
    const auto& contacts = kick.apply(x, t, plan.step);
    finite = x.v.allFinite();
    if (finite) recorder.add(i, t, contacts);
    whole_step.advance(x);
    if (progress && i % plan.window == 0) progress(double(i) / double(plan.n_steps));
  }

  Transient result = recorder.transient();
  result.speed = run.speed;
  result.finished = finite;
  result.growth_rate = growth_rate(result.envelope, linear_part * rest_compression(options));
  if (inertial) result.tail_a = in_inertial_frame(*inertial, tail_q, result.tail.t, run.speed);
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

}  // namespace chladni::squeal
