#include "squeal/stability/gradients.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/real_eigenvalues.hpp"
#include "squeal/brake/pad_basis.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/stability/eigenvalue_change.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd;

constexpr double pi = std::numbers::pi, step = 1e-5;

/// A number of the brake, and the state matrix with another value of it.
struct Variable {
  std::string key, unit;
  double value;
  double step;  ///< of differences; 0: a part of the value
  std::function<MatrixXd(double value, double speed)> A;
  std::function<MatrixXd(double speed)> dA;  ///< empty: by differences of A
};

/// In coordinates in which it can be differentiated.
MatrixXd matrix_of(const Brake& brake, double speed)
{
  if (const FlexibleDisc* body = brake.body())
    return smooth_state_matrix(body->inertial(), body->options(), speed);
  return brake.state_matrix(speed);
}

std::vector<Variable> variables_of(const Brake& brake)
{
  std::vector<Variable> variables;
  for (const auto& [parameter, value] : brake.parameters()) {
    variables.push_back(
        {.key = key_of(parameter),
         .unit = std::string(find_parameter(parameter.name)->unit),
         .value = value,
         .step = 0.0,
         .A = [&brake, parameter = parameter](
                  double x, double speed) { return matrix_of(*brake.with(parameter, x), speed); },
         .dA = {}});
  }
  for (BrakeNumber& number : brake.further_numbers()) {
    variables.push_back({.key = std::move(number.key),
                         .unit = std::move(number.unit),
                         .value = number.value,
                         .step = number.step,
                         .A = [with = std::move(number.with)](
                                  double x, double speed) { return matrix_of(*with(x), speed); },
                         .dA = std::move(number.derivative)});
  }
  return variables;
}

/// dA/dp at the value zero, where A may not be defined below it:
/// (-3 A(0) + 4 A(h) - A(2 h)) / (2 h).
MatrixXd derivative_at_zero(const Variable& p, double speed)
{
  const MatrixXd A = p.A(0.0, speed);
  double h = 1e-6;
  constexpr double largest = 1e12;
  while (h < largest && (p.A(h, speed) - A).norm() < step * A.norm()) h *= 10.0;
  return (4.0 * p.A(h, speed) - 3.0 * A - p.A(2.0 * h, speed)) / (2.0 * h);
}

/// dA/dp
MatrixXd derivative(const Variable& p, double speed)
{
  if (p.dA) return p.dA(speed);
  if (p.value == 0.0 && p.step == 0.0) return derivative_at_zero(p, speed);
  const double h = p.step > 0.0 ? p.step : step * std::abs(p.value);
  return (p.A(p.value + h, speed) - p.A(p.value - h, speed)) / (2.0 * h);
}

/// The least stable motion, then all others that grow by more than rounding, by falling growth.
std::vector<EigenvalueChange> motions_at(const MatrixXd& A)
{
  const Eigen::VectorXcd lambda = linear::real_eigenvalues(A);
  std::vector<Complex> upper;
  for (const Complex& one : lambda)
    if (one.imag() >= 0.0) upper.push_back(one);
  std::ranges::sort(upper, std::ranges::greater(), [](const Complex& one) { return one.real(); });
  constexpr double rounding = 1e-12;
  const double largest = lambda.cwiseAbs().maxCoeff();
  std::vector<EigenvalueChange> motions;
  for (const Complex& one : upper) {
    if (!motions.empty() && !(one.real() > rounding * largest)) break;
    EigenvalueChange motion(A, one);
    if (motions.empty() || one.real() > rounding * largest * motion.condition())
      motions.push_back(std::move(motion));
  }
  return motions;
}

/// The critical oscillation, and how its growth changes with the speed.
struct CriticalOscillation {
  CriticalSpeed at;
  EigenvalueChange change;
  double by_speed;  ///< d Re(lambda) / d Omega, 1
};

std::optional<CriticalOscillation> critical_oscillation(const Brake& brake, const SpeedRange& range)
{
  const StateMatrixAt A = state_matrix_at(brake);
  const auto critical = critical_speed(stability_until_critical(A, range));
  if (!critical) return std::nullopt;
  const double speed = critical->speed, h = step * speed;
  const EigenvalueChange change(matrix_of(brake, speed),
                                Complex(0.0, 2.0 * pi * critical->frequency_Hz));
  const MatrixXd dA = (matrix_of(brake, speed + h) - matrix_of(brake, speed - h)) / (2.0 * h);
  const double by_speed = change.of(dA).real();
  return CriticalOscillation{*critical, change, by_speed};
}

void require_something(const std::optional<CriticalOscillation>& critical,
                       const StudyOptions& options)
{
  if (critical || options.gradients) return;
  throw Error(
      fmt::format("gradients: there is no critical speed within [squeal] speeds, {:.6g} to {:.6g} "
                  "rad/s; take another range, or give gradients = {{ speed_rad_s = ... }} for "
                  "those of growth rates",
                  options.speeds.from, options.speeds.to));
}

}  // namespace

UsualChange usual_change(const GradientRow& row)
{
  if (!row.key.starts_with("part[")) return {0.01 * row.value, "1 %"};
  if (row.unit == "m") return {1e-4, "0.1 mm"};
  return {0.1, "0.1 degrees"};
}

double effect_of_usual_change(const Gradients& gradients, const GradientRow& row)
{
  const double change = std::abs(usual_change(row).value);
  if (gradients.critical_speed && row.critical_speed) return change * std::abs(*row.critical_speed);
  return row.growth.size() > 0 ? change * std::abs(row.growth[0]) : 0.0;
}

Gradients gradients(const Brake& brake, const StudyOptions& options)
{
  const auto critical = critical_oscillation(brake, options.speeds);
  require_something(critical, options);
  Gradients result;
  if (critical) {
    result.critical_speed = critical->at.speed;
    result.critical_frequency_Hz = critical->at.frequency_Hz;
  }
  std::vector<EigenvalueChange> motions;
  if (options.gradients) {
    result.speed = options.gradients->speed;
    motions = motions_at(matrix_of(brake, *result.speed));
  }
  for (const EigenvalueChange& motion : motions)
    result.motions.push_back({motion.lambda().real(), motion.lambda().imag() / (2.0 * pi)});
  for (const Variable& p : variables_of(brake)) {
    GradientRow row{.key = p.key, .unit = p.unit, .value = p.value};
    if (critical) {
      const double by_value = critical->change.of(derivative(p, critical->at.speed)).real();
      row.critical_speed = -by_value / critical->by_speed;
    }
    row.growth.resize(std::ssize(motions));
    const MatrixXd dA = result.speed ? derivative(p, *result.speed) : MatrixXd();
    for (Index i = 0; i < row.growth.size(); ++i)
      row.growth[i] = motions[static_cast<std::size_t>(i)].of(dA).real();
    result.rows.push_back(std::move(row));
  }
  std::ranges::stable_sort(result.rows, std::ranges::greater(), [&](const GradientRow& row) {
    return effect_of_usual_change(result, row);
  });
  return result;
}

}  // namespace chladni::squeal
