#include "squeal/fmu/brake_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "squeal/motion/dop853.hpp"

namespace chladni::brake_fmu {
namespace {

using Eigen::Index, Eigen::VectorXd;

double output_of(const squeal::PadState<double>& pad, PadOutput output)
{
  switch (output) {
    case PadOutput::normal_force:
      return pad.N;
    case PadOutput::axial_force:
      return pad.S;
    case PadOutput::radial_force:
      return pad.f_r;
    case PadOutput::tangential_force:
      return pad.f_t;
    case PadOutput::height:
      return pad.z;
    case PadOutput::velocity:
      return pad.z_dot;
  }
  return 0.0;
}

}  // namespace

BrakeSimulation::BrakeSimulation(BrakeModel model)
    : model_(std::make_unique<const BrakeModel>(std::move(model))),
      references_(model_->n_modes(), model_->pads.n_pads()),
      disc_(*model_)
{
  reset();
}

void BrakeSimulation::reset()
{
  time_ = 0.0;
  steps_per_period_ = usual_steps_per_period;
  drive_ = {
      .speed = model_->speed, .friction = model_->friction, .preloads = preloads_of(model_->pads)};
  x_ = VectorXd::Zero(1 + 2 * model_->n_modes());
}

VectorXd BrakeSimulation::rate(const VectorXd& x) const
{
  const Index n = model_->n_modes();
  VectorXd rate(x.size());
  rate[0] = drive_.speed;
  rate.segment(1, n) = x.tail(n);
  rate.tail(n) = disc_.acceleration(x[0], x.segment(1, n), x.tail(n));
  return rate;
}

VectorXd BrakeSimulation::derivatives() const
{
  disc_.set_drive(drive_);
  return rate(x_);
}

/// @param rates  x', after whose computation the disc knows its contacts
double BrakeSimulation::variable(std::uint32_t reference, const VectorXd& rates) const
{
  const BrakeReferences& of = references_;
  if (reference == BrakeReferences::time) return time_;
  if (reference == BrakeReferences::steps_per_period) return steps_per_period_;
  if (reference == BrakeReferences::speed) return drive_.speed;
  if (reference == BrakeReferences::friction) return drive_.friction;
  if (reference < of.torque()) return drive_.preloads[reference - of.preloads()];
  if (reference == of.torque()) return disc_.torque();
  if (reference < of.angle()) {
    const std::uint32_t place = reference - of.pads();
    const auto contacts = disc_.contacts();
    const auto& pair = contacts[place / (2 * n_pad_outputs)];
    const bool is_upper = place / n_pad_outputs % 2 == 0;
    return output_of(is_upper ? pair.upper : pair.lower,
                     static_cast<PadOutput>(place % n_pad_outputs));
  }
  if (reference < of.der_angle()) return x_[Index(reference - of.angle())];
  if (reference < of.end()) return rates[Index(reference - of.der_angle())];
  throw Error("there is no variable with the value reference " + std::to_string(reference));
}

std::vector<double> BrakeSimulation::values(std::span<const std::uint32_t> references) const
{
  const BrakeReferences& of = references_;
  const auto is_computed = [&](std::uint32_t reference) {
    return (reference >= of.torque() && reference < of.angle()) || reference >= of.der_angle();
  };
  VectorXd rates;
  if (std::ranges::any_of(references, is_computed)) rates = derivatives();
  std::vector<double> values;
  for (const std::uint32_t reference : references) values.push_back(variable(reference, rates));
  return values;
}

void BrakeSimulation::set_value(std::uint32_t reference, double value)
{
  const BrakeReferences& of = references_;
  const std::string name = "the variable with the value reference " + std::to_string(reference);
  if (!std::isfinite(value)) throw Error(name + " is set to a value that is no finite number");
  if (reference == BrakeReferences::time)
    time_ = value;
  else if (reference == BrakeReferences::steps_per_period && value >= 1.0)
    steps_per_period_ = value;
  else if (reference == BrakeReferences::speed)
    drive_.speed = value;
  else if (reference == BrakeReferences::friction)
    drive_.friction = value;
  else if (reference >= of.preloads() && reference < of.torque())
    drive_.preloads[reference - of.preloads()] = value;
  else if (reference >= of.angle() && reference < of.der_angle())
    x_[Index(reference - of.angle())] = value;
  else if (reference == BrakeReferences::steps_per_period)
    throw Error(name + ", steps in a period, must be at least 1");
  else
    throw Error(name + " cannot be set: it is computed or does not exist");
}

void BrakeSimulation::set_continuous_states(const VectorXd& x)
{
  if (!x.allFinite()) throw Error("a continuous state is set to a value that is no finite number");
  x_ = x;
}

std::vector<double> BrakeSimulation::directional_derivatives(
    std::span<const std::uint32_t> /*unknowns*/, const fmu::Direction& /*direction*/) const
{
  throw Error("a brake gives no directional derivatives");
}

void BrakeSimulation::advance(double h)
{
  if (!(h > 0.0) || !std::isfinite(h)) {
    throw Error("a step of " + std::to_string(h) +
                " s is not allowed; a step must be positive and finite");
  }
  disc_.set_drive(drive_);
  const auto [omega, decay] = disc_.fastest();
  // The method is stable up to decay times step of 5.
  const double by_decay = decay > 0.0 ? 2.5 / decay : h;
  const double step_max = std::min(2.0 * std::numbers::pi / omega / steps_per_period_, by_decay);
  const double n_steps = std::ceil(h / step_max);
  constexpr double most_steps = 1e9;
  if (n_steps > most_steps) {
    throw Error("a step of " + std::to_string(h) +
                " s needs more than 1e9 integration steps; take a shorter one");
  }
  VectorXd x = x_;
  const auto field = [&](const VectorXd& at) { return rate(at); };
  for (double i = 0.0; i < n_steps; i += 1.0) x = squeal::dop853_step(field, x, h / n_steps);
  if (!x.allFinite()) throw Error("the motion of the brake grows without bounds");
  x_ = x;
  time_ += h;
}

VectorXd BrakeSimulation::snapshot() const
{
  const auto n_pads = static_cast<Index>(drive_.preloads.size());
  VectorXd all(4 + n_pads + x_.size());
  all << time_, steps_per_period_, drive_.speed, drive_.friction,
      Eigen::Map<const VectorXd>(drive_.preloads.data(), n_pads), x_;
  return all;
}

void BrakeSimulation::restore(const VectorXd& snapshot)
{
  time_ = snapshot[0];
  steps_per_period_ = snapshot[1];
  drive_.speed = snapshot[2];
  drive_.friction = snapshot[3];
  std::copy_n(snapshot.data() + 4, drive_.preloads.size(), drive_.preloads.begin());
  x_ = snapshot.tail(x_.size());
}

}  // namespace chladni::brake_fmu
