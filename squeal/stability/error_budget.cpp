#include "squeal/stability/error_budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "squeal/brake/linear_contact.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// Relative; central differences of the state matrix are exact to its square.
constexpr double part_of_value = 1e-5;

/// An oscillation, and how its growth changes.
class GrowingMotion {
 public:
  GrowingMotion(const FlexibleDisc& brake, double speed, const std::complex<double>& lambda)
      : disc_(brake.inertial()),
        options_(brake.options()),
        speed_(speed),
        lambda_(state_matrix(disc_, options_, speed_), lambda)
  {}

  std::complex<double> lambda() const { return lambda_.lambda(); }

  /// Of the growth, by the speed; 1/s for each rad/s.
  double by_speed() const
  {
    return change(state_matrix(disc_, options_, speed_ * (1.0 + part_of_value)),
                  state_matrix(disc_, options_, speed_ * (1.0 - part_of_value))) /
           (2.0 * part_of_value * speed_);
  }

  /// By the logarithm of what a change of the disc scales, [1].
  Eigen::VectorXd by(const DiscScaling& scale) const
  {
    const auto scaled = [&](double factor) {
      InertialDisc disc = disc_;
      scale(disc, factor);
      return state_matrix(disc, options_, speed_);
    };
    return Eigen::VectorXd::Constant(
        1,
        change(scaled(1.0 + part_of_value), scaled(1.0 - part_of_value)) / (2.0 * part_of_value));
  }

  /// By as much as a change of the disc is at the factor 2, without sign, 1/s.
  double change_by(const DiscScaling& scale) const
  {
    InertialDisc disc = disc_;
    scale(disc, 2.0);
    const EigenvalueChange changed(state_matrix(disc, options_, speed_), lambda());
    return std::abs(changed.lambda().real() - lambda().real());
  }

 private:
  double change(const MatrixXd& to, const MatrixXd& from) const
  {
    return lambda_.of(to - from).real();
  }

  const InertialDisc& disc_;
  const SquealOptions& options_;
  double speed_;
  EigenvalueChange lambda_;
};

ErrorBudget by_errors_of_modes(const InertialDisc& disc, const GrowingMotion& growth)
{
  const DerivativeByDisc derivative = [&](const DiscScaling& scale) { return growth.by(scale); };
  ErrorBudget budget =
      errors_by_modes(disc, std::abs(growth.lambda().imag()), 1, derivative).budget(0);
  if (!budget.mesh || disc.errors.mesh_compliances.size() == 0) return budget;
  // Softer pads are nearer to another one in frequency, and what drives them is weaker: where these
  // effects cancel in first order, the change itself is larger.
  const double first_order = errors_by_compliance(disc, 1, derivative)[0];
  const double whole = growth.change_by(finer_under_the_pads(disc));
  *budget.mesh += std::max(0.0, whole - first_order);
  return budget;
}

}  // namespace

ErrorBudget growth_error_budget(const FlexibleDisc& brake, double speed,
                                const std::complex<double>& lambda)
{
  const GrowingMotion growth(brake, speed, lambda);
  ErrorBudget budget = by_errors_of_modes(brake.inertial(), growth);
  if (const FlexibleDisc* complete = brake.complete(); complete && complete->is_autonomous()) {
    const EigenvalueChange of_all(complete->state_matrix(speed), growth.lambda());
    budget.left_out = std::abs(of_all.lambda().real() - growth.lambda().real());
  }
  return budget;
}

ErrorBudget error_budget(const FlexibleDisc& brake, const CriticalSpeed& critical)
{
  const GrowingMotion growth(brake, critical.speed,
                             {0.0, 2.0 * std::numbers::pi * critical.frequency_Hz});
  ErrorBudget budget = by_errors_of_modes(brake.inertial(), growth);
  const double slope = std::abs(growth.by_speed());
  for (auto* part : {&budget.mesh, &budget.reduction, &budget.body})
    if (*part) **part /= slope;
  if (const FlexibleDisc* complete = brake.complete(); complete && complete->is_autonomous()) {
    const auto of_all = critical_speed(
        stability_until_critical(state_matrix_at(*complete), brake.options().study.speeds));
    if (of_all) budget.left_out = std::abs(of_all->speed - critical.speed);
  }
  return budget;
}

namespace {

/// Where the errors of W, W_r, W_t, V_r and V_t stand in ModeErrors::mesh_shapes: a radial slope is
/// a rotation about the circumferential direction.
constexpr std::array<Index, 5> rows_of_functions{2, 4, 3, 0, 1};

/// The frequency of a mode or a pair.
DiscScaling of_frequency(Index first, Index size)
{
  return [=](InertialDisc& disc, double factor) { disc.omega.segment(first, size) *= factor; };
}

/// What the rings do in some modes.
/// @param f  which of W, W_r, W_t, V_r, V_t
DiscScaling of_motion(Index first, Index size, std::size_t f)
{
  return [=](InertialDisc& disc, double factor) {
    for (InertialRing& ring : disc.rings) {
      const std::vector<VectorXd*> amplitudes = amplitudes_of(ring);
      if (f < amplitudes.size()) amplitudes[f]->segment(first, size) *= factor;
    }
  };
}

/// Halvings of the elements that the error by the mesh covers: there is no end to them for a force
/// at a point. Another mesh of a quarter of the size may place its nodes still nearer to the pads.
constexpr double halvings = 2.0, of_other_meshes = 1.4;
/// Where the functions of a ring stand in ModeErrors::mesh_compliances.
constexpr std::array<Index, 5> compliances_of_functions{0, 2, 2, 1, 1};

/// The compliance of one function of a ring under a pad, by an amount for a factor of e. It belongs
/// to a point alone, so that all harmonics have the same of it.
DiscScaling of_compliance(Index ring, Index f, double amount)
{
  return [=](InertialDisc& disc, double factor) {
    std::vector<Eigen::MatrixXcd>& C = disc.compliance.C;
    const Index n_functions = std::ssize(amplitudes_of(disc.rings.front()));
    const Index n = n_functions * std::ssize(disc.rings), row = n_functions * ring + f;
    if (C.empty())
      C.assign(static_cast<std::size_t>(disc.errors.n_harmonics), Eigen::MatrixXcd::Zero(n, n));
    const double share = (factor - 1.0) * amount / (2.0 * double(C.size()) - 1.0);
    for (std::size_t d = 0; d < C.size(); ++d) C[d](row, row) += (d == 0 ? 1.0 : 2.0) * share;
  };
}

/// The results of a disc, and how they change.
struct ChangingResults {
  const InertialDisc& disc;
  Index n;
  const DerivativeByDisc& derivative;

  /// The sum over all modes and pairs of error times derivative, without sign.
  /// @param errors   [n_modes] relative
  /// @param scaling  of a mode or pair by its first coordinate and their number
  template <class Scaling>
  VectorXd sum_over_modes(const VectorXd& errors, const Scaling& scaling) const
  {
    VectorXd sum = VectorXd::Zero(n);
    Index size = 1;
    for (Index i = 0; i < errors.size(); i += size) {
      size = disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 ? 2 : 1;
      if (errors[i] > 0.0) sum += errors[i] * derivative(scaling(i, size)).cwiseAbs();
    }
    return sum;
  }
};

/// What a finer mesh yields more of each function of each ring.
std::vector<DiscScaling> finer_functions(const InertialDisc& disc)
{
  std::vector<DiscScaling> all;
  const std::size_t n_functions = disc.rings.front().V_r.size() > 0 ? 5 : 3;
  const Eigen::MatrixXd& growth = disc.errors.mesh_compliances;
  for (Index ring = 0; ring < growth.cols(); ++ring)
    for (std::size_t f = 0; f < n_functions; ++f) {
      const double amount = halvings * of_other_meshes * growth(compliances_of_functions[f], ring);
      all.push_back(of_compliance(ring, static_cast<Index>(f), amount));
    }
  return all;
}

}  // namespace

ErrorBudget ErrorsByModes::budget(Index result) const
{
  const auto part = [result](const std::optional<VectorXd>& errors) {
    return errors ? std::optional((*errors)[result]) : std::nullopt;
  };
  return {.mesh = part(mesh), .reduction = part(reduction), .body = part(body)};
}

VectorXd errors_by_compliance(const InertialDisc& disc, Index n_results,
                              const DerivativeByDisc& derivative)
{
  VectorXd sum = VectorXd::Zero(n_results);
  for (const DiscScaling& finer : finer_functions(disc)) sum += derivative(finer).cwiseAbs();
  return sum;
}

DiscScaling finer_under_the_pads(const InertialDisc& disc)
{
  return [all = finer_functions(disc)](InertialDisc& changed, double factor) {
    for (const DiscScaling& finer : all) finer(changed, factor);
  };
}

ErrorsByModes errors_by_modes(const InertialDisc& disc, double omega, Index n_results,
                              const DerivativeByDisc& derivative)
{
  ErrorsByModes found;
  const ModeErrors& errors = disc.errors;
  if (omega > errors.range) return found;
  const ChangingResults results{disc, n_results, derivative};
  if (errors.mesh.size() > 0) {
    found.mesh = results.sum_over_modes(errors.mesh, of_frequency);
    for (std::size_t f = 0; f < rows_of_functions.size() && errors.mesh_shapes.size() > 0; ++f) {
      *found.mesh += results.sum_over_modes(
          errors.mesh_shapes.row(rows_of_functions[f]),
          [f](Index first, Index size) { return of_motion(first, size, f); });
    }
    *found.mesh += errors_by_compliance(disc, n_results, derivative);
  }
  if (errors.reduction.size() > 0)
    found.reduction = results.sum_over_modes(errors.reduction, of_frequency);
  if (errors.responses) {
    // A response is quadratic in the motion of its place.
    found.body = VectorXd::Zero(n_results);
    for (std::size_t f = 0; f < rows_of_functions.size(); ++f)
      *found.body += derivative(of_motion(0, disc.n_modes(), f)).cwiseAbs();
    *found.body *= 0.5 * *errors.responses;
  }
  return found;
}

}  // namespace chladni::squeal
