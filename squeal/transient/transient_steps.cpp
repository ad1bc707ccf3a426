#include "squeal/transient/transient_steps.hpp"

#include <limits>
#include <numbers>
#include <optional>

#include "squeal/motion/disc_motion.hpp"
#include "squeal/motion/dop853.hpp"
#include "squeal/motion/dormand_prince.hpp"
#include "squeal/motion/generalised_alpha.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

namespace {

ModalState with_plates_at_rest(ModalState x, Eigen::Index n)
{
  x.q.conservativeResizeLike(Eigen::VectorXd::Zero(n));
  x.v.conservativeResizeLike(Eigen::VectorXd::Zero(n));
  return x;
}

/// Exact flow of the damped modes over half a step, kick of the pads, exact flow over half a step.
/// The two half flows between two kicks are one; a sample is in the middle of a kick, to which the
/// splitting is symmetric in time.
class SplittingSteps final : public ModalSteps {
 public:
  SplittingSteps(const Disc& disc, const SquealOptions& options, const TransientCase& run,
                 double step, const ModalState& start)
      : kick_(disc, options, run.speed), n_modes_(disc.n_modes()), run_(run), step_(step)
  {
    const FreeBrake brake = free_brake(disc, kick_.pads(), 0.0);  // Coriolis terms are in the kick
    flow_.emplace(brake.omega, brake.C, step);
    x_ = with_plates_at_rest(start, brake.omega.size());
    OscillatorFlow(brake.omega, brake.C, 0.5 * step).advance(x_);
  }

  const std::vector<ContactResult<double>>& next() override
  {
    if (n_ > 0) flow_->advance(x_);
    v_before_ = x_.v;
    const auto& contacts = kick_.apply(x_, turn_at(run_, (double(n_) + 0.5) * step_), step_);
    ++n_;
    return contacts;
  }
  ModalState state() const override
  {
    return {x_.q.head(n_modes_), 0.5 * (v_before_ + x_.v).head(n_modes_)};
  }
  std::int64_t n_steps() const override { return n_; }
  std::int64_t n_contact_evaluations() const override { return 2 * n_; }

 private:
  ContactKick kick_;
  std::optional<OscillatorFlow> flow_;
  Eigen::Index n_modes_;
  TransientCase run_;
  double step_;
  ModalState x_;
  Eigen::VectorXd v_before_;  ///< the last kick
  std::int64_t n_ = 0;
};

class ExponentialSteps final : public ModalSteps {
 public:
  ExponentialSteps(const Disc& disc, const SquealOptions& options, double speed, double step,
                   const ModalState& start)
      : inertial_(inertial_disc(disc)),
        flow_(inertial_, options, speed, step),
        angle_step_(speed * step),
        x_(Eigen::VectorXd::Zero(flow_.size()))
  {
    const Eigen::MatrixXd& R = inertial_.R;
    const Eigen::Index n = disc.n_modes();
    x_.head(n) = inertial_.omega.cwiseProduct(R.transpose() * start.q);
    x_.segment(flow_.size() / 2, n) = R.transpose() * start.v;
    flow_.advance_half(x_);
  }

  const std::vector<ContactResult<double>>& next() override
  {
    if (n_++ > 0) flow_.advance(x_);
    p_before_ = x_.segment(x_.size() / 2, inertial_.n_modes());
    return flow_.kick(x_);
  }
  ModalState state() const override
  {
    const Eigen::Index n = inertial_.n_modes();
    const double angle = -angle_step_ * (double(n_) - 0.5);
    const Eigen::VectorXd a = x_.head(n).cwiseQuotient(inertial_.omega);
    const Eigen::VectorXd p = 0.5 * (p_before_ + x_.segment(x_.size() / 2, n));
    return {inertial_.R * turned(inertial_, a, angle), inertial_.R * turned(inertial_, p, angle)};
  }
  std::int64_t n_steps() const override { return n_; }
  std::int64_t n_contact_evaluations() const override { return 2 * n_; }

 private:
  InertialDisc inertial_;
  ExponentialFlow flow_;
  double angle_step_;
  Eigen::VectorXd x_;
  Eigen::VectorXd p_before_;  ///< the last kick
  std::int64_t n_ = 0;
};

Eigen::VectorXd scaled(const Eigen::VectorXd& omega, const ModalState& x)
{
  Eigen::VectorXd y(2 * omega.size());
  y << omega.cwiseProduct(x.q), x.v;
  return y;
}

/// Samples of the dense output of an integrator with adaptive steps.
template <class Method>
class AdaptiveSteps final : public ModalSteps {
 public:
  AdaptiveSteps(const Disc& disc, const SquealOptions& options, double speed,
                const IntegratorChoice& choice, double step, const ModalState& start)
      : motion_(disc, options, speed),
        method_(motion_, 0.0,
                scaled(motion_.omega(), with_plates_at_rest(start, motion_.omega().size())),
                control_of(motion_, choice)),
        n_modes_(disc.n_modes()),
        step_(step)
  {}

  const std::vector<ContactResult<double>>& next() override
  {
    const double t = (double(n_++) + 0.5) * step_;
    y_ = method_.at(t);
    contacts_ = motion_.contacts(t, y_);
    return contacts_;
  }
  ModalState state() const override
  {
    const Eigen::Index n = motion_.omega().size();
    return {y_.head(n).cwiseQuotient(motion_.omega()).head(n_modes_), y_.segment(n, n_modes_)};
  }
  std::int64_t n_steps() const override { return method_.cost().n_steps; }
  std::int64_t n_contact_evaluations() const override { return motion_.n_evaluations() + n_; }
  std::vector<ContactEvent> events() const override
  {
    std::vector<ContactEvent> events;
    if constexpr (requires { method_.events(); })
      for (const SwitchEvent& event : method_.events())
        events.push_back({event.t, motion_.pad_of(event.i), event.side > 0.0});
    return events;
  }
  std::int64_t n_events() const override { return method_.cost().n_events; }

 private:
  static StepControl control_of(const Motion& motion, const IntegratorChoice& choice)
  {
    const double period = 2.0 * std::numbers::pi / motion.omega().maxCoeff();
    const double largest = period / choice.steps_per_period;
    return {choice.tolerance, largest, 0.5 * largest};
  }

  RotatingDisc motion_;
  Method method_;
  Eigen::Index n_modes_;
  double step_;
  Eigen::VectorXd y_;
  std::vector<ContactResult<double>> contacts_;
  std::int64_t n_ = 0;
};

}  // namespace

std::unique_ptr<ModalSteps> transient_steps(const Disc& disc, const SquealOptions& options,
                                            const TransientCase& run,
                                            const IntegratorChoice& choice, double step,
                                            const ModalState& start)
{
  const double speed = run.speed;
  switch (choice.kind) {
    case IntegratorKind::exponential:
      return std::make_unique<ExponentialSteps>(disc, options, speed, step, start);
    case IntegratorKind::dormand_prince:
      return std::make_unique<AdaptiveSteps<DormandPrince>>(disc, options, speed, choice, step,
                                                            start);
    case IntegratorKind::generalised_alpha:
      return std::make_unique<AdaptiveSteps<GeneralisedAlpha>>(
          disc, with_friction_at_rest(options, disc, speed), speed, choice, step, start);
    case IntegratorKind::automatic:
    case IntegratorKind::splitting:
      break;
  }
  return std::make_unique<SplittingSteps>(disc, options, run, step, start);
}

LumpedSteps::LumpedSteps(const LumpedBrake& brake, const TransientCase& run, double step)
    : brake_(brake),
      speed_(run.speed),
      step_(step),
      x_(brake.start(run.initial_pad_displacement)),
      contacts_(1)
{}

const std::vector<ContactResult<double>>& LumpedSteps::next()
{
  contacts_[0] = brake_.contact(x_, speed_);
  ++n_evaluations_;
  if (!(x_.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < motion_max))
    contacts_[0].upper.z = std::numeric_limits<double>::quiet_NaN();
  const auto f = [&](const Eigen::VectorXd& x) {
    ++n_evaluations_;
    return brake_.rate(x, speed_);
  };
  x_ = dop853_step(f, x_, step_);
  ++n_;
  return contacts_;
}

}  // namespace chladni::squeal
