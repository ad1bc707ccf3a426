#include "mbs_export/fmu/instance.hpp"

#include <cmath>
#include <utility>

#include "common/error.hpp"

namespace chladni::fmu {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Where a reference stands in a group of variables that begins at `first`; -1 if it does not.
Index place(std::uint32_t reference, std::uint32_t first, Index n)
{
  const bool is_there = reference >= first && reference - first < static_cast<std::uint64_t>(n);
  return is_there ? static_cast<Index>(reference - first) : -1;
}

}  // namespace

Instance::Instance(ModalModel model)
    : model_(std::make_shared<const ModalModel>(std::move(model))),
      references_(model_->n_modes(), model_->n_dofs())
{
  reset();
}

void Instance::reset()
{
  const Index n = model_->n_modes();
  state_ = {.damping_ratios = VectorXd::Zero(n),
            .F = VectorXd::Zero(model_->n_dofs()),
            .q = VectorXd::Zero(n),
            .q_dot = VectorXd::Zero(n)};
}

MatrixXd Instance::damping() const
{
  const Index n = model_->n_modes();
  MatrixXd C = model_->C.size() > 0 ? MatrixXd(state_.damping_factor * model_->C)
                                    : MatrixXd(MatrixXd::Zero(n, n));
  C.diagonal() += 2.0 * state_.damping_ratios.cwiseProduct(model_->omega);
  return C;
}

VectorXd Instance::acceleration(const State& state) const
{
  VectorXd a = model_->Phi.transpose() * state.F - model_->omega.cwiseAbs2().cwiseProduct(state.q) -
               2.0 * state_.damping_ratios.cwiseProduct(model_->omega).cwiseProduct(state.q_dot);
  if (model_->C.size() > 0) a -= state_.damping_factor * (model_->C * state.q_dot);
  return a;
}

/// Variables in one state, for all of which q'' is computed at most once.
class Instance::Evaluation {
 public:
  Evaluation(const Instance& instance, const State& state) : in_(instance), state_(state) {}
  double value(std::uint32_t reference);

 private:
  const VectorXd& q_ddot()
  {
    if (!q_ddot_) q_ddot_ = in_.acceleration(state_);
    return *q_ddot_;
  }

  const Instance& in_;
  const State& state_;
  std::optional<VectorXd> q_ddot_;
};

double Instance::Evaluation::value(std::uint32_t reference)
{
  const ModalModel& model = *in_.model_;
  const Index n_modes = model.n_modes(), n_dofs = model.n_dofs();
  const References& of = in_.references_;
  const State& state = state_;
  Index i = 0;
  if (reference == References::time) return state.time;
  if (reference == References::damping_factor) return state.damping_factor;
  if (i = place(reference, of.damping_ratios(), n_modes); i >= 0) return state.damping_ratios[i];
  if (i = place(reference, of.forces(), n_dofs); i >= 0) return state.F[i];
  if (i = place(reference, of.displacements(), n_dofs); i >= 0)
    return model.Phi.row(i).dot(state.q);
  if (i = place(reference, of.velocities(), n_dofs); i >= 0)
    return model.Phi.row(i).dot(state.q_dot);
  if (i = place(reference, of.accelerations(), n_dofs); i >= 0)
    return model.Phi.row(i).dot(q_ddot());
  if (i = place(reference, of.q(), n_modes); i >= 0) return state.q[i];
  if (i = place(reference, of.q_dot(), n_modes); i >= 0) return state.q_dot[i];
  if (i = place(reference, of.der_q(), n_modes); i >= 0) return state.q_dot[i];
  if (i = place(reference, of.der_q_dot(), n_modes); i >= 0) return q_ddot()[i];
  throw Error("there is no variable with the value reference " + std::to_string(reference));
}

std::vector<double> Instance::values_in(const State& state,
                                        std::span<const std::uint32_t> references) const
{
  Evaluation evaluation(*this, state);
  std::vector<double> values;
  for (const std::uint32_t reference : references) values.push_back(evaluation.value(reference));
  return values;
}

std::vector<double> Instance::values(std::span<const std::uint32_t> references) const
{
  return values_in(state_, references);
}

void Instance::set_value(std::uint32_t reference, double value)
{
  if (!std::isfinite(value)) {
    throw Error("the variable with the value reference " + std::to_string(reference) +
                " is set to a value that is no finite number");
  }
  const References& of = references_;
  Index i = 0;
  if (reference == References::time)
    state_.time = value;
  else if (reference == References::damping_factor)
    state_.damping_factor = value;
  else if (i = place(reference, of.damping_ratios(), model_->n_modes()); i >= 0)
    state_.damping_ratios[i] = value;
  else if (i = place(reference, of.forces(), model_->n_dofs()); i >= 0)
    state_.F[i] = value;
  else if (i = place(reference, of.q(), model_->n_modes()); i >= 0)
    state_.q[i] = value;
  else if (i = place(reference, of.q_dot(), model_->n_modes()); i >= 0)
    state_.q_dot[i] = value;
  else
    throw Error("the variable with the value reference " + std::to_string(reference) +
                " cannot be set: it is computed or does not exist");
}

VectorXd Instance::continuous_states() const
{
  VectorXd x(2 * model_->n_modes());
  x << state_.q, state_.q_dot;
  return x;
}

void Instance::set_continuous_states(const VectorXd& x)
{
  if (!x.allFinite()) throw Error("a continuous state is set to a value that is no finite number");
  state_.q = x.head(model_->n_modes());
  state_.q_dot = x.tail(model_->n_modes());
}

VectorXd Instance::derivatives() const
{
  VectorXd derivatives(2 * model_->n_modes());
  derivatives << state_.q_dot, acceleration(state_);
  return derivatives;
}

/// Nothing changes but what is named.
State Instance::change_along(const Direction& direction) const
{
  const References& of = references_;
  const Index n_modes = model_->n_modes();
  State change{.damping_factor = 0.0,
               .damping_ratios = VectorXd::Zero(n_modes),
               .F = VectorXd::Zero(model_->n_dofs()),
               .q = VectorXd::Zero(n_modes),
               .q_dot = VectorXd::Zero(n_modes)};
  for (std::size_t k = 0; k < direction.references.size(); ++k) {
    const std::uint32_t known = direction.references[k];
    Index i = 0;
    if (known == References::time) continue;  // nothing depends on time itself
    if (i = place(known, of.forces(), model_->n_dofs()); i >= 0)
      change.F[i] += direction.changes[k];
    else if (i = place(known, of.q(), n_modes); i >= 0)
      change.q[i] += direction.changes[k];
    else if (i = place(known, of.q_dot(), n_modes); i >= 0)
      change.q_dot[i] += direction.changes[k];
    else
      throw Error("the variable with the value reference " + std::to_string(known) +
                  " is neither a state nor an input");
  }
  return change;
}

/// The model is linear in states and inputs.
std::vector<double> Instance::directional_derivatives(std::span<const std::uint32_t> unknowns,
                                                      const Direction& direction) const
{
  return values_in(change_along(direction), unknowns);
}

VectorXd Instance::snapshot() const
{
  VectorXd all(2 + 3 * model_->n_modes() + model_->n_dofs());
  all << state_.time, state_.damping_factor, state_.damping_ratios, state_.F, state_.q,
      state_.q_dot;
  return all;
}

void Instance::restore(const VectorXd& snapshot)
{
  const Index n_modes = model_->n_modes(), n_dofs = model_->n_dofs();
  state_ = {.time = snapshot[0],
            .damping_factor = snapshot[1],
            .damping_ratios = snapshot.segment(2, n_modes),
            .F = snapshot.segment(2 + n_modes, n_dofs),
            .q = snapshot.segment(2 + n_modes + n_dofs, n_modes),
            .q_dot = snapshot.tail(n_modes)};
}

void Instance::advance(double h)
{
  if (!(h > 0.0) || !std::isfinite(h)) {
    throw Error("a step of " + std::to_string(h) +
                " s is not allowed; a step must be positive and finite");
  }
  const bool is_kept = kept_ && kept_->h == h && kept_->damping_factor == state_.damping_factor &&
                       kept_->damping_ratios == state_.damping_ratios;
  if (!is_kept) {
    kept_ = {.h = h,
             .damping_factor = state_.damping_factor,
             .damping_ratios = state_.damping_ratios,
             .propagator = propagator(model_->omega, damping(), h)};
  }
  const VectorXd x = kept_->propagator.from_state * continuous_states() +
                     kept_->propagator.from_force * (model_->Phi.transpose() * state_.F);
  set_continuous_states(x);
  state_.time += h;
}

}  // namespace chladni::fmu
