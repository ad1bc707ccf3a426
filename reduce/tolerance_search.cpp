#include "reduce/tolerance_search.hpp"

#include "common/told_apart.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chladni::reduce {

namespace {

constexpr PetscInt n_at_first = 48;
constexpr double pair_gap = 1e-4;    // of frequencies: partners stay together
constexpr double same_value = 1e-8;  // of frequencies of converged modes

/// Whether `before` are the first values of `now`: a partner that a search finds late shifts them.
bool begins_with(const std::vector<double>& now, const std::vector<double>& before)
{
  for (std::size_t i = 0; i < before.size(); ++i)
    if (std::abs(now[i] - before[i]) > same_value * before[i]) return false;
  return true;
}

}  // namespace

ToleranceSearch::ToleranceSearch(const GrowingModel::System& system, const ToleranceGoal& goal,
                                 PairsOf pairs_in_range, MemoryCheck require_memory)
    : system_(system),
      goal_(goal),
      pairs_in_range_(std::move(pairs_in_range)),
      search_(system.K_ss, system.M.ss, std::move(require_memory)),
      n_asked_(n_at_first)
{}

/// Modes that are found together with all their partners.
PetscInt ToleranceSearch::n_complete() const
{
  const std::vector<double>& omega = search_.omega();
  const auto n_all = static_cast<PetscInt>(omega.size());
  if (search_.has_all()) return n_all;
  for (PetscInt n = n_all - 1; n > 0; --n)
    if (omega[n] - omega[n - 1] > pair_gap * omega[n]) return n;
  return n_all;
}

void ToleranceSearch::find_modes()
{
  search_.find(std::min(n_asked_, search_.n_slaves()));
  const std::vector<double>& omega = search_.omega();
  PetscInt n = n_complete();
  if (model_ && n <= model_->n_modes()) n = static_cast<PetscInt>(omega.size());  // no others
  if (model_ && n <= model_->n_modes() && error(n) <= goal_.tolerance) {
    throw Error(fmt::format(
        "with all {} fixed-interface modes that converge a frequency of the range may be "
        "missing: M is nearly singular, or masses differ too much; lower the range",
        n));
  }
  if (model_ && n <= model_->n_modes()) {
    const auto [reached, asked] = told_apart(error(n), goal_.tolerance);
    throw Error(
        fmt::format("with all {} fixed-interface modes that there are the estimated error is {}, "
                    "above the tolerance {}; raise the tolerance",
                    n, reached, asked));
  }
  if (model_ && !begins_with(omega, model_->omega())) model_.reset();
  if (!model_) model_.emplace(system_);
  const PetscInt n_before = model_->n_modes();
  model_->append(search_.shapes(n_before, n), {omega.begin() + n_before, omega.begin() + n});
}

double ToleranceSearch::error(PetscInt n) const
{
  const ReducedPairs pairs = pairs_in_range_(model_->model(n));
  std::vector<double> errors = model_->error_estimates(pairs, n);
  const double last = n > 0 ? model_->omega()[n - 1] : 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double of_frequency = frequency_error(errors[i], pairs.lambda[i], last * last);
    const double Hz = std::sqrt(pairs.lambda[i]) / (2.0 * std::numbers::pi);
    errors[i] = Hz * (1.0 - of_frequency) > goal_.up_to_Hz ? 0.0 : of_frequency;
  }
  const double largest = errors.empty() ? 0.0 : std::ranges::max(errors);
  return linear::value_of_first_rank(largest, petsc::communicator(system_.Psi));
}

/// Of the first mode beyond the first n, or less.
double ToleranceSearch::lambda_left_out(PetscInt n) const
{
  const std::vector<double>& omega = search_.omega();
  if (n < std::ssize(omega)) return omega[n] * omega[n];
  return search_.has_all() ? search_.unresolved_from() : omega.back() * omega.back();
}

/// Whether the FE model may have more frequencies in the range than the reduced one has there or
/// within the tolerance above it.
bool ToleranceSearch::may_lack_a_frequency(PetscInt n) const
{
  const double sigma = std::pow(2.0 * std::numbers::pi * goal_.up_to_Hz, 2);
  const double left_out = lambda_left_out(n);
  if (left_out <= sigma) return true;
  const auto n_below = [&](const ReducedModel& model, double end) {
    const ReducedPairs pairs = pairs_in_range_(model);
    return std::ranges::upper_bound(pairs.lambda, end) - pairs.lambda.begin();
  };
  const auto most = n_below(model_->heavier_model(n, sigma, left_out), sigma);
  const auto found = n_below(model_->model(n), sigma * (1.0 + 2.0 * goal_.tolerance));
  return linear::value_of_first_rank(most > found ? 1.0 : 0.0, petsc::communicator(system_.Psi)) !=
         0.0;
}

/// Of the modes at hand, those of the range.
PetscInt ToleranceSearch::n_in_range() const
{
  const std::vector<double>& omega = model_->omega();
  const double last = 2.0 * std::numbers::pi * goal_.up_to_Hz;
  return static_cast<PetscInt>(std::ranges::upper_bound(omega, last) - omega.begin());
}

/// Whether a mode beyond the range is at hand, or all that there are.
bool ToleranceSearch::covers_range() const
{
  return n_in_range() < model_->n_modes() || search_.has_all();
}

/// How many modes the range has, if their number grows with the frequency as in a plate.
PetscInt ToleranceSearch::more_of_range() const
{
  const PetscInt n = model_->n_modes();
  const double predicted =
      1.1 * n * 2.0 * std::numbers::pi * goal_.up_to_Hz / model_->omega().back();
  return static_cast<PetscInt>(std::clamp(predicted, 1.15 * n, 3.0 * n)) + 1;
}

bool ToleranceSearch::is_enough()
{
  if (!covers_range()) {
    n_asked_ = more_of_range();
    return false;
  }
  search_.require_resolved(std::pow(2.0 * std::numbers::pi * goal_.up_to_Hz, 2));
  const double last_error = error(model_->n_modes());
  if (last_error > goal_.tolerance) {
    too_few_.push_back({.n = model_->n_modes(), .error = last_error});
    n_asked_ = prediction();
    return false;
  }
  if (may_lack_a_frequency(model_->n_modes())) {
    n_asked_ = model_->n_modes() + model_->n_modes() / 4 + 1;
    return false;
  }
  n_enough_ = search_.complete_cluster(least());
  return true;
}

/// By bisection to 1 % or one mode, not below the modes of the range.
PetscInt ToleranceSearch::least() const
{
  const PetscInt all = model_->n_modes();
  const PetscInt too_few = std::max(too_few_.empty() ? 0 : too_few_.back().n, n_in_range() - 1);
  const PetscInt n = std::max<PetscInt>(
      1, bisected(too_few, all, [&](PetscInt k) { return error(k) <= goal_.tolerance; }));
  if (!may_lack_a_frequency(n)) return n;
  return bisected(n, all, [&](PetscInt k) { return !may_lack_a_frequency(k); });
}

PetscInt ToleranceSearch::bisected(PetscInt too_few, PetscInt enough,
                                   const std::function<bool(PetscInt)>& is_enough) const
{
  while (enough - too_few > std::max<PetscInt>(1, enough / 100)) {
    const PetscInt n = (enough + too_few) / 2;
    (is_enough(n) ? enough : too_few) = n;
  }
  return enough;
}

/// A number of modes that keeps the tolerance if the error goes on to fall as a power of it, from
/// the errors with all modes and with half of them or less: over less the error falls in jumps.
/// Between 1.15 and 1.5 times as many for the same reason, or twice where that is far from enough.
PetscInt ToleranceSearch::prediction() const
{
  const Tried last = too_few_.back();
  const PetscInt n = last.n;
  const auto before = std::find_if(too_few_.rbegin(), too_few_.rend(),
                                   [&](const Tried& t) { return 2 * t.n <= n; });
  const Tried half = before != too_few_.rend() ? *before : Tried{.n = n / 2, .error = error(n / 2)};
  const double fallen = std::log(half.error / last.error) / std::log(double(n) / half.n);
  const double power = std::max(0.5, fallen);
  const double predicted = 1.1 * n * std::pow(last.error / goal_.tolerance, 1.0 / power);
  const double most = predicted > 3.0 * n ? 2.0 : 1.5;
  return static_cast<PetscInt>(std::clamp(predicted, 1.15 * n, most * n)) + 1;
}

}  // namespace chladni::reduce
