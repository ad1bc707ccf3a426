#include "squeal/stability/mode_sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/real_eigenvalues.hpp"
#include "squeal/brake/state_matrix.hpp"
#include "squeal/root.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

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
struct CriticalOscillation {
  double speed;
  Complex lambda;
  Eigen::VectorXcd v;  ///< eigenvector
};

ModeInfluence influence_of(const InertialDisc& disc, const SquealOptions& options,
                           const std::vector<Family>& others, const CriticalOscillation& critical)
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
                                      const CriticalOscillation& critical)
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
  const CriticalOscillation oscillation{
      critical->speed, lambda,
      eigenvector_near(state_matrix(disc, options, critical->speed), lambda)};
  return {.critical_speed = critical->speed,
          .critical_frequency_Hz = critical->frequency_Hz,
          .subsets = subsets(disc, options, families, critical->speed),
          .influences = influences(disc, options, families, oscillation)};
}

}  // namespace chladni::squeal
