#include "squeal/stability/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>
#include <type_traits>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/models/parameters.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/hill.hpp"
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

/// df/dp by central differences; at the value zero, below which f may not be defined,
/// (-3 f(0) + 4 f(h) - f(2 h)) / (2 h).
/// @param step  0: a part of the value
template <class Function>
std::invoke_result_t<Function, double> derivative_by(double value, double step, const Function& f)
{
  if (value != 0.0 || step > 0.0) {
    const double h = step > 0.0 ? step : relative_step * std::abs(value);
    return (f(value + h) - f(value - h)) / (2.0 * h);
  }
  const auto at_zero = f(0.0);
  double h = 1e-6;
  constexpr double largest = 1e12;
  while (h < largest && (f(h) - at_zero).norm() < relative_step * at_zero.norm()) h *= 10.0;
  return (4.0 * f(h) - 3.0 * at_zero - f(2.0 * h)) / (2.0 * h);
}

/// dA/dp
MatrixXd matrix_derivative(const Variable& p, double speed)
{
  if (p.dA) return p.dA(speed);
  return derivative_by(p.value, p.step,
                       [&](double value) -> MatrixXd { return p.A(value, speed); });
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

void require_something(bool has_critical_speed, const StudyOptions& options)
{
  if (has_critical_speed || options.gradients) return;
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

namespace {

void sort_by_effect(Gradients& gradients)
{
  std::ranges::stable_sort(gradients.rows, std::ranges::greater(), [&](const GradientRow& row) {
    return effect_of_usual_change(gradients, row);
  });
}

}  // namespace

Gradients gradients(const Brake& brake, const StudyOptions& options)
{
  const auto critical = critical_oscillation(brake, options.speeds);
  require_something(critical.has_value(), options);
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
  sort_by_effect(result);
  return result;
}

namespace {

/// Motions of a turning disc at one speed, and what they change by. With L(lambda) the operator
/// A(phi) - speed d/dphi, d lambda = mean of l^T dL r.
class TurningChange {
 public:
  /// @param omega  as of Hill::motions
  TurningChange(const FlexibleDisc& brake, double speed, Index n, std::optional<double> omega = {})
      : options_(&brake.options()),
        speed_(speed),
        hill_(brake.disc(), brake.options()),
        motions_(hill_.motions(speed, n, omega)),
        n_disc_(brake.disc().n_modes())
  {
    if (motions_.lambda.size() > 0) return;
    throw Error(
        fmt::format("gradients: at {:.6g} rad/s the motion that grows most cannot be told from "
                    "another one; change the speed a little",
                    speed));
  }

  const Eigen::VectorXcd& lambda() const { return motions_.lambda; }

  /// By a parameter of the pads.
  Eigen::VectorXcd by(const ParameterValue& p) const
  {
    return form(derivative_by(p.value, 0.0, [&](double value) {
      return images(with_parameter(*options_, p.parameter, value), speed_);
    }));
  }

  /// By the speed: d/dphi r = (A r - lambda r) / speed.
  Eigen::VectorXcd by_speed() const
  {
    const auto image = [&](double speed) { return images(*options_, speed); };
    return form(derivative_by(speed_, 0.0, image)) -
           (form(image(speed_)) - motions_.lambda) / speed_;
  }

  /// By the frequency of each mode, 1/s per Hz; [n_modes x k].
  Eigen::MatrixXcd by_frequencies(const Eigen::VectorXd& omega) const
  {
    const TurningBrake brake = hill_.brake(*options_, speed_);
    Eigen::MatrixXcd changes = Eigen::MatrixXcd::Zero(n_disc_, lambda().size());
    const Eigen::VectorXd by_w = brake.scale().head(n_disc_).cwiseInverse();
    for_each_angle([&](Index /*s*/, double phi, const MatrixXd& L, const MatrixXd& R) {
      const Index n = L.rows() / 2;
      // One mode of other frequency turns with the disc: it has not its symmetry.
      for (int period = 0; period < motions_.nu; ++period) {
        const double angle = phi + 2.0 * pi * period / motions_.nu;
        changes += products(brake.in_modes(angle, L.middleRows(n, n_disc_)),
                            brake.in_modes(angle, by_w.asDiagonal() * R.topRows(n_disc_)));
      }
    });
    return -4.0 * pi / motions_.nu * omega.asDiagonal() * changes;
  }

 private:
  /// A r at all angles with the matrix of other options or another speed, in coordinates that
  /// depend smoothly on the pads. What does not change is the same to the last digit.
  MatrixXd images(const SquealOptions& options, double speed) const
  {
    TurningBrake brake = hill_.brake(options, speed);
    const MatrixXd turn = pad_basis(options).transpose() * pad_basis(*options_);
    const auto turned = [](const MatrixXd& of_pads, MatrixXd X) {
      const Index n = X.rows() / 2, m = of_pads.rows();
      for (const Index end : {n, 2 * n})
        X.middleRows(end - m, m) = (of_pads * X.middleRows(end - m, m)).eval();
      return X;
    };
    MatrixXd all(motions_.right.front().rows(), 0);
    for_each_angle([&](Index s, double phi, const MatrixXd& /*L*/, const MatrixXd& R) {
      if (s == 0) all.resize(R.rows(), R.cols() * motions_.right.front().cols());
      all.middleCols(s * R.cols(), R.cols()) =
          turned(turn.transpose(), brake.times(phi, turned(turn, R)));
    });
    return all;
  }

  /// Mean of l^T times such images.
  Eigen::VectorXcd form(const MatrixXd& images) const
  {
    Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(lambda().size());
    for_each_angle([&](Index s, double /*phi*/, const MatrixXd& L, const MatrixXd& R) {
      const MatrixXd image = images.middleCols(s * R.cols(), R.cols());
      sum += products(L, image).colwise().sum().transpose();
    });
    return sum;
  }

  /// Calls f(s, phi, L, R) with the vectors of all motions, real and imaginary parts side by side,
  /// L over the number of angles.
  template <class Function>
  void for_each_angle(const Function& f) const
  {
    const Index k = lambda().size(), m = motions_.right.front().rows();
    const Index N = motions_.right.front().cols();
    MatrixXd L(m, 2 * k), R(m, 2 * k);
    for (Index s = 0; s < N; ++s) {
      for (Index j = 0; j < k; ++j) {
        const auto at = static_cast<std::size_t>(j);
        L.col(j) = motions_.left[at].col(s).real() / double(N);
        L.col(k + j) = motions_.left[at].col(s).imag() / double(N);
        R.col(j) = motions_.right[at].col(s).real();
        R.col(k + j) = motions_.right[at].col(s).imag();
      }
      f(s, 2.0 * pi * double(s) / double(N * motions_.nu), L, R);
    }
  }

  /// Complex products of each pair of columns, entry by entry.
  static Eigen::MatrixXcd products(const MatrixXd& L, const MatrixXd& R)
  {
    const Index k = L.cols() / 2;
    Eigen::MatrixXcd product(L.rows(), k);
    const auto L_re = L.leftCols(k).array(), L_im = L.rightCols(k).array();
    const auto R_re = R.leftCols(k).array(), R_im = R.rightCols(k).array();
    product.real() = (L_re * R_re - L_im * R_im).matrix();
    product.imag() = (L_re * R_im + L_im * R_re).matrix();
    return product;
  }

  const SquealOptions* options_;
  double speed_;
  Hill hill_;
  FloquetMotions motions_;
  Index n_disc_;
};

/// Growth rates by all numbers, in the order of `turning_rows`.
MatrixXd growth_by_all(const FlexibleDisc& brake, const TurningChange& change)
{
  const std::vector<ParameterValue> parameters = brake.parameters();
  const Index n = std::ssize(parameters), n_modes = brake.disc().n_modes();
  MatrixXd growth(n + n_modes, change.lambda().size());
  for_each_index(static_cast<int>(n), [&](int i) {
    growth.row(i) = change.by(parameters[static_cast<std::size_t>(i)]).real().transpose();
  });
  growth.bottomRows(n_modes) = change.by_frequencies(brake.disc().omega).real();
  return growth;
}

std::vector<GradientRow> turning_rows(const FlexibleDisc& brake)
{
  std::vector<GradientRow> rows;
  for (const auto& [parameter, value] : brake.parameters()) {
    rows.push_back({.key = key_of(parameter),
                    .unit = std::string(find_parameter(parameter.name)->unit),
                    .value = value});
  }
  for (Index i = 0; i < brake.disc().n_modes(); ++i) {
    const double f_Hz = brake.disc().omega[i] / (2.0 * pi);
    const int number = brake.disc().mode_numbers[static_cast<std::size_t>(i)];
    rows.push_back({.key = fmt::format("frequency of mode {} at {:.6g} Hz", number, f_Hz),
                    .unit = "Hz",
                    .value = f_Hz});
  }
  return rows;
}

}  // namespace

Gradients turning_gradients(const FlexibleDisc& brake, const StudyOptions& options,
                            const std::optional<CriticalSpeed>& critical)
{
  constexpr Index most_motions = 5;
  require_something(critical.has_value(), options);
  Gradients result;
  result.rows = turning_rows(brake);
  const auto each_row = [&](const auto& f) {
    for (std::size_t i = 0; i < result.rows.size(); ++i) f(result.rows[i], static_cast<Index>(i));
  };
  if (critical) {
    result.critical_speed = critical->speed;
    result.critical_frequency_Hz = critical->frequency_Hz;
    const TurningChange change(brake, critical->speed, 1, 2.0 * pi * critical->frequency_Hz);
    const MatrixXd growth = growth_by_all(brake, change);
    const double by_speed = change.by_speed()[0].real();
    each_row([&](GradientRow& row, Index i) { row.critical_speed = -growth(i, 0) / by_speed; });
  }
  if (options.gradients) {
    result.speed = options.gradients->speed;
    const TurningChange change(brake, *result.speed, most_motions);
    for (const Complex& lambda : change.lambda())
      result.motions.push_back({lambda.real(), std::abs(lambda.imag()) / (2.0 * pi)});
    const MatrixXd growth = growth_by_all(brake, change);
    each_row([&](GradientRow& row, Index i) { row.growth = growth.row(i).transpose(); });
  }
  sort_by_effect(result);
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
