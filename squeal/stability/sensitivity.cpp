#include "squeal/stability/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

using Eigen::Index, Eigen::MatrixXd;
using std::numbers::pi;

namespace {

using Complex = std::complex<double>;

constexpr double relative_step = 1e-5;

/// A number of the brake, and the state matrix with another value of it.
struct Variable {
  std::string key, unit;
  double value;
  double step;  ///< of differences; 0: a part of the value
  std::function<MatrixXd(double value, double speed)> A;
  std::function<MatrixXd(double speed)> dA;  ///< empty: by differences of A
};

/// In coordinates in which it can be differentiated.
MatrixXd matrix_at(const Brake& brake, double speed)
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
                  double x, double speed) { return matrix_at(*brake.with(parameter, x), speed); },
         .dA = {}});
  }
  for (BrakeNumber& number : brake.further_numbers()) {
    variables.push_back({.key = std::move(number.key),
                         .unit = std::move(number.unit),
                         .value = number.value,
                         .step = number.step,
                         .A = [with = std::move(number.with)](
                                  double x, double speed) { return matrix_at(*with(x), speed); },
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
  while (h < largest && (p.A(h, speed) - A).norm() < relative_step * A.norm()) h *= 10.0;
  return (4.0 * p.A(h, speed) - 3.0 * A - p.A(2.0 * h, speed)) / (2.0 * h);
}

/// dA/dp
MatrixXd matrix_derivative(const Variable& p, double speed)
{
  if (p.dA) return p.dA(speed);
  if (p.value == 0.0 && p.step == 0.0) return derivative_at_zero(p, speed);
  const double h = p.step > 0.0 ? p.step : relative_step * std::abs(p.value);
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
  const double speed = critical->speed, h = relative_step * speed;
  const EigenvalueChange change(matrix_at(brake, speed),
                                Complex(0.0, 2.0 * pi * critical->frequency_Hz));
  const MatrixXd dA = (matrix_at(brake, speed + h) - matrix_at(brake, speed - h)) / (2.0 * h);
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
    motions = motions_at(matrix_at(brake, *result.speed));
  }
  for (const EigenvalueChange& motion : motions)
    result.motions.push_back({motion.lambda().real(), motion.lambda().imag() / (2.0 * pi)});
  for (const Variable& p : variables_of(brake)) {
    GradientRow row{.key = p.key, .unit = p.unit, .value = p.value};
    if (critical) {
      const double by_value = critical->change.of(matrix_derivative(p, critical->at.speed)).real();
      row.critical_speed = -by_value / critical->by_speed;
    }
    row.growth.resize(std::ssize(motions));
    const MatrixXd dA = result.speed ? matrix_derivative(p, *result.speed) : MatrixXd();
    for (Index i = 0; i < row.growth.size(); ++i)
      row.growth[i] = motions[static_cast<std::size_t>(i)].of(dA).real();
    result.rows.push_back(std::move(row));
  }
  std::ranges::stable_sort(result.rows, std::ranges::greater(), [&](const GradientRow& row) {
    return effect_of_usual_change(result, row);
  });
  return result;
}

namespace {

/// Factors by which the range about the critical speed is widened in search of another crossing.
constexpr double ranges[] = {1.01, 1.05, 1.2, 1.5, 2.0, 4.0};
constexpr int mode_counts[] = {2, 8, 16};

/// A mode (n = 0) or a pair: its coordinates are neighbours.
struct Family {
  Eigen::Index first;
  Eigen::Index size;
};

std::vector<Family> families_by_frequency(const InertialDisc& disc)
{
  std::vector<Family> families;
  for (Eigen::Index i = 0; i < disc.n_modes(); i += families.back().size)
    families.push_back({i, disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 ? 2 : 1});
  std::ranges::sort(families, [&](const Family& a, const Family& b) {
    return disc.omega[a.first] < disc.omega[b.first];
  });
  return families;
}

/// The disc with these families alone. R is not kept: the state matrix has no use for it.
InertialDisc with_families(const InertialDisc& disc, const std::vector<Family>& families)
{
  std::vector<Eigen::Index> kept;
  for (const Family& family : families)
    for (Eigen::Index i = 0; i < family.size; ++i) kept.push_back(family.first + i);
  InertialDisc part = disc;
  part.nodal_diameters.clear();
  for (const Eigen::Index i : kept)
    part.nodal_diameters.push_back(disc.nodal_diameters[static_cast<std::size_t>(i)]);
  part.omega = disc.omega(kept);
  for (InertialRing& ring : part.rings)
    for (Eigen::VectorXd* amplitude : amplitudes_of(ring))
      *amplitude = Eigen::VectorXd((*amplitude)(kept));
  for (auto member : {&InertialDisc::C, &InertialDisc::D, &InertialDisc::G, &InertialDisc::R})
    part.*member = Eigen::MatrixXd((disc.*member)(kept, kept));
  return part;
}

/// The state matrix of a part of the modes over the speed; keeps references to its arguments.
StateMatrixAt matrices_of(const InertialDisc& part, const SquealOptions& options)
{
  return [&](double speed) { return state_matrix(part, options, speed); };
}

/// The eigenvalue of A nearest to `expected`.
Complex nearest_eigenvalue(const Eigen::MatrixXd& A, const Complex& expected)
{
  const Eigen::VectorXcd lambda = linear::real_eigenvalues(A);
  Eigen::Index at = 0;
  (lambda.array() - expected).abs().minCoeff(&at);
  return lambda[at];
}

/// The speed at which the eigenvalue near `expected` crosses the imaginary axis, in the narrowest
/// range about `speed` that holds a crossing.
std::optional<double> crossing_near(const StateMatrixAt& A, double speed, const Complex& expected)
{
  const auto growth = [&](double x) { return nearest_eigenvalue(A(x), expected).real(); };
  for (const double factor : ranges)
    if (growth(speed / factor) < 0.0 && growth(speed * factor) > 0.0)
      return root(growth, speed / factor, speed * factor, 1e-10);
  return std::nullopt;
}

/// Part of the kinetic energy of an eigenvector that is in each family.
double participation(const Eigen::VectorXcd& v, const Family& family)
{
  const Eigen::Index n = v.size() / 2;
  return v.segment(n + family.first, family.size).squaredNorm() / v.tail(n).squaredNorm();
}

Eigen::VectorXcd eigenvector_near(const Eigen::MatrixXd& A, const Complex& expected)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  Eigen::Index at = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&at);
  return solver.eigenvectors().col(at);
}

ModeSubset subset_of(const InertialDisc& part, const SquealOptions& options, double speed)
{
  const StabilityProfile profile =
      stability_until_critical(matrices_of(part, options), options.study.speeds);
  const auto critical = critical_speed(profile);
  ModeSubset subset{.n_modes = static_cast<int>(part.n_modes()),
                    .highest_Hz = part.omega.maxCoeff() / (2.0 * pi),
                    .critical_speed = {},
                    .critical_frequency_Hz = {},
                    .growth = least_stable_eigenvalue(state_matrix(part, options, speed)).real(),
                    .stability = name_of(stability_of(profile))};
  if (critical) {
    subset.critical_speed = critical->speed;
    subset.critical_frequency_Hz = critical->frequency_Hz;
  }
  return subset;
}

std::vector<ModeSubset> subsets(const InertialDisc& disc, const SquealOptions& options,
                                const std::vector<Family>& families, double speed)
{
  std::vector<ModeSubset> rows;
  std::vector<Family> kept;
  Eigen::Index n = 0;
  for (const Family& family : families) {
    kept.push_back(family);
    n += family.size;
    const bool wanted = std::any_of(std::begin(mode_counts), std::end(mode_counts), [&](int count) {
      return n >= count && n - family.size < count;
    });
    if (wanted || n == disc.n_modes())
      rows.push_back(subset_of(with_families(disc, kept), options, speed));
  }
  return rows;
}

/// The critical oscillation of all modes.
struct LimitOscillation {
  double speed;
  Complex lambda;
  Eigen::VectorXcd v;  ///< eigenvector
};

ModeInfluence influence_of(const InertialDisc& disc, const SquealOptions& options,
                           const std::vector<Family>& others, const LimitOscillation& critical)
{
  ModeInfluence influence{};
  if (others.empty()) return influence;
  const InertialDisc part = with_families(disc, others);
  const StateMatrixAt A = matrices_of(part, options);
  influence.growth_without = nearest_eigenvalue(A(critical.speed), critical.lambda).real();
  influence.critical_speed_without = crossing_near(A, critical.speed, critical.lambda);
  return influence;
}

std::vector<ModeInfluence> influences(const InertialDisc& disc, const SquealOptions& options,
                                      const std::vector<Family>& families,
                                      const LimitOscillation& critical)
{
  std::vector<ModeInfluence> rows;
  for (const Family& family : families) {
    std::vector<Family> others;
    for (const Family& other : families)
      if (other.first != family.first) others.push_back(other);
    const double part = participation(critical.v, family);
    // Without the mode that it consists of there is no such oscillation.
    ModeInfluence row =
        part < 0.5 ? influence_of(disc, options, others, critical) : ModeInfluence{};
    row.nodal_diameters = disc.nodal_diameters[static_cast<std::size_t>(family.first)];
    row.frequency_Hz = disc.omega[family.first] / (2.0 * pi);
    row.participation = part;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

ModeSensitivity mode_sensitivity(const InertialDisc& disc, const SquealOptions& options)
{
  const StabilityProfile profile =
      stability_until_critical(matrices_of(disc, options), options.study.speeds);
  const auto critical = critical_speed(profile);
  if (!critical) {
    throw Error(
        fmt::format("mode sensitivity: there is no critical speed within [squeal] speeds, {:.6g} "
                    "to {:.6g} rad/s (stability: {}); take another range",
                    profile.from.value, profile.to.value, name_of(stability_of(profile))));
  }
  const Complex lambda(0.0, 2.0 * pi * critical->frequency_Hz);
  const std::vector<Family> families = families_by_frequency(disc);
  const LimitOscillation oscillation{
      critical->speed, lambda,
      eigenvector_near(state_matrix(disc, options, critical->speed), lambda)};
  return {.critical_speed = critical->speed,
          .critical_frequency_Hz = critical->frequency_Hz,
          .subsets = subsets(disc, options, families, critical->speed),
          .influences = influences(disc, options, families, oscillation)};
}

}  // namespace chladni::squeal
