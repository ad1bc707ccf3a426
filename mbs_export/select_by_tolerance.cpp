#include "mbs_export/select_by_tolerance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

#include "common/eigen_every.hpp"
#include "linear/dense/rank_update.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/held_modes.hpp"
#include "mbs_export/response_error.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

namespace {

/// A basis and the steps that led to it.
struct Path {
  TrialBasis basis;
  std::vector<SelectionStep> steps;
};

/// A load and a grid frequency.
struct Place {
  Index load;
  Index g;
};

struct Candidate {
  std::string name;
  std::variant<ModeCluster, InterfaceChoice> addition;
  Growth growth;
};

Place worst_place(const TrialBasis& basis)
{
  Place worst{};
  basis.error.maxCoeff(&worst.load, &worst.g);
  return worst;
}

SelectionStep step_of(const TrialBasis& basis, const std::string& added)
{
  return {.added = added,
          .n_modes = basis.n_kept(),
          .n_interface = static_cast<int>(basis.omega_p.size()),
          .error = basis.error.maxCoeff()};
}

/// What is still to be gained: the sum of log(error / tolerance) where this is positive.
double excess(const MatrixXd& errors, double tolerance)
{
  double sum = 0.0;
  for (const double error : errors.reshaped()) {
    if (std::isnan(error)) return std::numeric_limits<double>::infinity();
    if (error > tolerance) sum += std::log(error / tolerance);
  }
  return sum;
}

/// The modes of a body that take part in a choice.
struct MovedModes {
  std::vector<int> of_all;  ///< ascending, 0-based
  ReferenceResponse reference;
};

std::string candidate_name(const MovedModes& modes, const ModeCluster& cluster)
{
  const auto number = [&](int k) { return modes.of_all[std::size_t(k)] + 1; };
  const int first = number(cluster.first), last = number(cluster.end - 1);
  if (cluster.end - cluster.first == 1) return fmt::format("mode {}", last);
  if (cluster.end - cluster.first == 2) return fmt::format("modes {}, {}", first, last);
  return fmt::format("modes {} to {}", first, last);
}

std::string candidate_name(const LoadGroup& group, double Omega_0)
{
  if (Omega_0 == 0.0) return group.name + ", static";
  return fmt::format("{}, {:.6g} Hz", group.name, Omega_0 / (2.0 * std::numbers::pi));
}

/// The cluster that carries most of the response which the basis misses at a place.
std::optional<ModeCluster> largest_missing_cluster(const ReferenceResponse& reference,
                                                   const TrialBasis& basis, const Place& place)
{
  const VectorXcd x = missing_response(reference, basis, place.load, place.g);
  std::optional<ModeCluster> largest;
  double largest_norm = 0.0;
  for (const ModeCluster& cluster : reference.clusters) {
    if (basis.is_kept[std::size_t(cluster.first)]) continue;
    const Index n = cluster.end - cluster.first;
    const double norm =
        (reference.B.middleRows(cluster.first, n).transpose() * x.segment(cluster.first, n)).norm();
    if (largest && norm <= largest_norm) continue;
    largest = cluster;
    largest_norm = norm;
  }
  return largest;
}

/// The group of loads whose response makes most of the error at a place.
const LoadGroup* largest_missing_group(const TrialBasis& basis, std::span<const LoadGroup> groups,
                                       const Place& place)
{
  const MatrixXcd& remainder = basis.remainder[std::size_t(place.g)];
  const LoadGroup* largest = nullptr;
  double largest_norm = -1.0;
  for (const LoadGroup& group : groups) {
    const MatrixXd& P = group.patterns;
    const double norm =
        linear::symmetric_product(remainder, P * P.row(place.load).transpose()).norm();
    if (norm <= largest_norm) continue;
    largest = &group;
    largest_norm = norm;
  }
  return largest;
}

bool meets_neglected_mode(const ReferenceResponse& reference, const TrialBasis& basis,
                          double Omega_0)
{
  for (Index k = 0; k < reference.omega.size(); ++k) {
    if (!basis.is_kept[std::size_t(k)] &&
        std::abs(reference.omega[k] - Omega_0) <= 1e-6 * reference.omega[k])
      return true;
  }
  return false;
}

std::optional<Candidate> interface_candidate(const ReferenceResponse& reference,
                                             const TrialBasis& basis,
                                             std::span<const LoadGroup> groups, const Place& place)
{
  const LoadGroup* group = largest_missing_group(basis, groups, place);
  if (group == nullptr) return std::nullopt;
  const double Omega_0 = group->Omega_0.value_or(reference.Omega[place.g]);
  if (meets_neglected_mode(reference, basis, Omega_0)) return std::nullopt;
  const InterfaceChoice choice{group->patterns, Omega_0};
  Growth growth = growth_with(reference, basis, choice);
  if (growth.n_modes == 0) return std::nullopt;
  return Candidate{candidate_name(*group, Omega_0), choice, std::move(growth)};
}

std::vector<Candidate> candidates(const MovedModes& modes, const TrialBasis& basis,
                                  std::span<const LoadGroup> groups)
{
  const ReferenceResponse& reference = modes.reference;
  const Place worst = worst_place(basis);
  Place lowest{0, 0};
  basis.error.col(0).maxCoeff(&lowest.load);
  std::vector<Candidate> all;
  if (const auto cluster = largest_missing_cluster(reference, basis, worst)) {
    all.push_back(
        {candidate_name(modes, *cluster), *cluster, growth_with(reference, basis, *cluster)});
  }
  if (auto candidate = interface_candidate(reference, basis, groups, worst))
    all.push_back(std::move(*candidate));
  if (worst.g != 0)
    if (auto candidate = interface_candidate(reference, basis, groups, lowest))
      all.push_back(std::move(*candidate));
  return all;
}

TrialBasis with(const ReferenceResponse& reference, TrialBasis basis, const Candidate& candidate)
{
  if (const auto* cluster = std::get_if<ModeCluster>(&candidate.addition))
    return with_cluster(reference, std::move(basis), *cluster);
  return with_interface(reference, std::move(basis), std::get<InterfaceChoice>(candidate.addition));
}

/// Adds modes until the tolerance is met or none is left.
Path grow(const MovedModes& modes, Path path, double tolerance)
{
  const ReferenceResponse& reference = modes.reference;
  while (path.basis.error.maxCoeff() > tolerance) {
    const auto cluster = largest_missing_cluster(reference, path.basis, worst_place(path.basis));
    if (!cluster) break;
    path.basis = with_cluster(reference, std::move(path.basis), *cluster);
    path.steps.push_back(step_of(path.basis, candidate_name(modes, *cluster)));
  }
  return path;
}

/// Adds the candidate with the largest gain for each of its modes.
/// @return false if there is none but those that depend on the basis
bool add_best(const MovedModes& modes, Path& path, std::vector<Candidate> all, double tolerance)
{
  const double now = excess(path.basis.error, tolerance);
  const auto gain = [&](const Candidate& candidate) {
    return (now - excess(candidate.growth.error, tolerance)) / candidate.growth.n_modes;
  };
  const auto n_added = [&] {
    return std::size_t(path.basis.n_kept()) + path.basis.interface.size();
  };
  std::ranges::stable_sort(all, std::greater<>(), gain);
  for (const Candidate& candidate : all) {
    const std::size_t n_before = n_added();
    path.basis = with(modes.reference, std::move(path.basis), candidate);
    if (n_added() == n_before) continue;
    path.steps.push_back(step_of(path.basis, candidate.name));
    return true;
  }
  return false;
}

/// Adds candidates until the tolerance is met or nothing is left to add.
Path grow(const MovedModes& modes, Path path, std::span<const LoadGroup> groups, double tolerance)
{
  while (path.basis.error.maxCoeff() > tolerance) {
    path.basis = with_outputs(modes.reference, std::move(path.basis));
    if (!add_best(modes, path, candidates(modes, path.basis, groups), tolerance)) break;
  }
  return path;
}

/// Rigid modes and the resonances that the loads excite.
Path resonant_path(const MovedModes& modes)
{
  const ReferenceResponse& reference = modes.reference;
  Path path{rigid_basis(reference), {}};
  if (path.basis.n_kept() > 0)
    path.steps.push_back(step_of(path.basis, candidate_name(modes, reference.clusters.front())));
  for (const int c : reference.resonances) {
    const ModeCluster& cluster = reference.clusters[std::size_t(c)];
    path.basis = with_cluster(reference, std::move(path.basis), cluster);
    path.steps.push_back(step_of(path.basis, candidate_name(modes, cluster)));
  }
  return path;
}

MovedModes modes_of_choice(const Eigen::VectorXd& omega, const MatrixXd& B, const LoadedDofs& loads,
                           const Tolerance& tolerance)
{
  std::vector<int> moved = moved_modes(omega, B);
  ReferenceResponse reference = reference_response(omega(moved), B(moved, every), loads, tolerance);
  return {std::move(moved), std::move(reference)};
}

/// The one that meets the tolerance with fewer modes, else the more accurate one.
const Path& better(const Path& modes, const Path& mixed, double tolerance)
{
  const double error_modes = modes.basis.error.maxCoeff(),
               error_mixed = mixed.basis.error.maxCoeff();
  if (std::max(error_modes, error_mixed) > tolerance)
    return error_modes <= error_mixed ? modes : mixed;
  return modes.basis.n_modes() <= mixed.basis.n_modes() ? modes : mixed;
}

}  // namespace

ToleranceSelection select_by_tolerance(const Eigen::VectorXd& omega, const MatrixXd& B,
                                       const LoadedDofs& loads, const Tolerance& tolerance)
{
  const MovedModes moved = modes_of_choice(omega, B, loads, tolerance);
  const Path start = resonant_path(moved);
  const Path modes = grow(moved, start, tolerance.error);
  const Path mixed = grow(moved, start, loads.groups, tolerance.error);
  const Path& chosen = better(modes, mixed, tolerance.error);
  ToleranceSelection selection{.kept = {},
                               .neglected = {},
                               .interface = chosen.basis.interface,
                               .table = {.error = tolerance.error,
                                         .Omega_max = 2.0 * std::numbers::pi * tolerance.up_to_Hz,
                                         .loads = loads.names,
                                         .modes_only = modes.steps,
                                         .with_interface_modes = mixed.steps}};
  std::vector<char> is_kept(static_cast<std::size_t>(omega.size()), 0);
  for (std::size_t k = 0; k < moved.of_all.size(); ++k)
    is_kept[std::size_t(moved.of_all[k])] = chosen.basis.is_kept[k];
  for (int k = 0; k < int(omega.size()); ++k)
    (is_kept[std::size_t(k)] ? selection.kept : selection.neglected).push_back(k);
  return selection;
}

namespace {

int master_of(const ReducedSystem& reduced, int dof)
{
  if (const auto row = master_row(reduced, dof / 6, dof % 6)) return *row;
  throw BodyOptionError("keep.tolerance",
                        "responses can be compared with the FE model at masters only, and nodes of "
                        "a ring of harmonics are none");
}

/// What sizes are not below in a band: the least of both halves, until it is close to a size that
/// occurs.
class LeastSizes {
 public:
  explicit LeastSizes(const ReferenceResponse& reference) : reference_(reference) {}

  VectorXd between(double from, double to)
  {
    occurring_ = sizes_in_band(reference_, from, to).in_middle;
    return at_least(from, to, 0);
  }

 private:
  VectorXd at_least(double from, double to, int depth)
  {
    constexpr double close = 0.7;
    constexpr int deepest = 10;
    const SizesInBand sizes = sizes_in_band(reference_, from, to);
    occurring_ = occurring_.cwiseMin(sizes.in_middle);
    if (depth == deepest || (sizes.at_least.array() >= close * occurring_.array()).all())
      return sizes.at_least;
    const double middle = 0.5 * (from + to);
    const VectorXd lower = at_least(from, middle, depth + 1);
    return lower.cwiseMin(at_least(middle, to, depth + 1));
  }

  const ReferenceResponse& reference_;
  VectorXd occurring_;  ///< the least sizes of all frequencies that were looked at
};

/// All modes of the held body, and their motion at some DOFs.
struct Shapes {
  VectorXd omega;  ///< [n] rad/s
  MatrixXd B;      ///< [n x m]
};

/// Without rigid-body motions, and where masters are held, one eigenproblem is enough.
Shapes shapes_at(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                 const std::vector<int>& dofs)
{
  const HeldModeShapes modes = held_mode_shapes(reduced, fixed);
  if (modes.n_rigid == 0)
    return {modes.omega, attachment_motion(reduced, modes.X)(dofs, every).transpose()};
  const HeldBody body = held_body(reduced, fixed);
  return {body.omega, body.U(dofs, every).transpose()};
}

}  // namespace

ResponseSizes response_sizes(const ReferenceResponse& reference, const Tolerance& tolerance)
{
  constexpr Index n_bands = 24;
  const double end = 2.0 * std::numbers::pi * tolerance.up_to_Hz;
  ResponseSizes sizes{.rows = {},
                      .names = {},
                      .unit = reference.unit,
                      .Omega = VectorXd::LinSpaced(n_bands + 1, 0.0, end),
                      .size = MatrixXd(reference.B.cols(), n_bands)};
  LeastSizes least(reference);
  for (Index g = 0; g < n_bands; ++g)
    sizes.size.col(g) = least.between(sizes.Omega[g], sizes.Omega[g + 1]);
  return sizes;
}

ResponseSizes response_sizes(const ReducedSystem& reduced, const BodyOptions& options)
{
  const LoadedDofs loads =
      loaded_dofs(reduced, held_dofs(reduced, options.fixed), options.interface_modes);
  Shapes shapes = shapes_at(reduced, options.fixed, loads.dofs);
  shapes.B = loads.worked_on(shapes.B.transpose()).transpose();
  const std::vector<int> moved = moved_modes(shapes.omega, shapes.B);
  ResponseSizes sizes =
      response_sizes(reference_modes(shapes.omega(moved), shapes.B(moved, every), loads),
                     options.keep.tolerance.value());
  sizes.names = loads.names;
  for (const int dof : loads.dofs) sizes.rows.push_back(master_of(reduced, dof));
  sizes.spread = loads.spread;
  return sizes;
}

}  // namespace chladni::mbs_export
