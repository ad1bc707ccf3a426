#include "squeal/brake/mode_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "common/error.hpp"
#include "squeal/brake/rotation_generator.hpp"

namespace chladni::squeal {
namespace {

using mbs_export::ModalBody;
using mbs_export::ModeKind;
using std::numbers::pi;

/// Below this angular frequency (0.1 Hz) a mode counts as a rigid-body motion, rad/s.
constexpr double rigid_limit = 0.2 * pi;

/// Ring motion below this part of the largest one that a pad feels at the frequency of the mode, a
/// 4e-6th of its kinetic energy, is that of a mode in the plane of the disc: rounding of the FE
/// model, or what a hat or vanes make of torsion.
constexpr double still_limit = 2e-3;

/// Squared amplitude of each harmonic of each mode on all rings, slopes multiplied by the radius.
Eigen::MatrixXd ring_motion(const Disc& disc)
{
  return ring_harmonics(disc.rings).squares_by_harmonic();
}

/// [n_modes] squared amplitudes of harmonic n / 2 on a ring of an even number n of nodes.
Eigen::VectorXd alternating_motion(const DiscRing& ring, Eigen::Index n_modes)
{
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(n_modes);
  for (const auto& [f, scale] : functions_of(ring))
    for (Eigen::Index d = ring.n_whole_harmonics(); d < f->cosine.rows(); ++d) {
      sum +=
          scale * scale * (f->cosine.row(d).cwiseAbs2() + f->sine.row(d).cwiseAbs2()).transpose();
    }
  return sum;
}

/// What the modes do to the rings, 0-based and ascending.
struct Motions {
  std::vector<int> moving;  ///< along the axis
  /// Most of it with harmonic n / 2, of which a ring of n nodes shows one phase.
  std::vector<int> alternating;
  std::vector<int> still;
};

/// Of each mode the largest squared motion of the rings that a pad feels at its frequency, or at
/// the end of the range where that is higher. To a pad a mode far above is a spring of the
/// compliance W^2 / omega^2: what a reduction has there, of little mass and large motion, counts by
/// that.
Eigen::VectorXd felt_motion(const Disc& disc, const Eigen::VectorXd& motion)
{
  const double lowest = std::max(disc.errors.range, rigid_limit);
  const Eigen::ArrayXd lambda = disc.omega.cwiseMax(lowest).cwiseAbs2();
  Eigen::VectorXd felt(disc.n_modes());
  for (Eigen::Index i = 0; i < felt.size(); ++i)
    felt[i] = (motion.array() * (lambda[i] / lambda).min(1.0)).maxCoeff();
  return felt;
}

/// A ring of other nodes may show both modes of a pair.
Motions motions_of(const Disc& disc)
{
  const Eigen::VectorXd all = ring_motion(disc).colwise().sum().transpose();
  const Eigen::VectorXd limit = still_limit * still_limit * felt_motion(disc, all);
  std::vector<char> alternates(std::size_t(disc.n_modes()), 0), moves(alternates);
  for (const DiscRing& ring : disc.rings) {
    const Eigen::VectorXd alternating = alternating_motion(ring, disc.n_modes()),
                          whole = ring_harmonics({ring}).squares();
    for (Eigen::Index i = 0; i < disc.n_modes(); ++i) {
      if (std::max(whole[i], alternating[i]) <= limit[i]) continue;
      (alternating[i] > whole[i] ? alternates : moves)[std::size_t(i)] = 1;
    }
  }
  Motions motions;
  for (int i = 0; i < disc.n_modes(); ++i) {
    const bool is_alternating = alternates[std::size_t(i)] != 0 && moves[std::size_t(i)] == 0;
    (is_alternating      ? motions.alternating
     : all[i] > limit[i] ? motions.moving
                         : motions.still)
        .push_back(i);
  }
  return motions;
}

std::vector<int> counted_from_one(std::vector<int> modes)
{
  for (int& i : modes) ++i;
  return modes;
}

std::vector<int> modes_with_nodal_diameters(const Disc& disc, int n)
{
  const std::vector<int> diameters = nodal_diameters(disc);
  const std::size_t wanted = n == 0 ? 1 : 2;
  std::vector<int> modes;
  for (const int i : motions_of(disc).moving)
    if (diameters[i] == n && modes.size() < wanted) modes.push_back(i);
  if (modes.size() < wanted) {
    throw Error(
        fmt::format("use_modes: the body has {} of the {} modes with {} nodal diameters; "
                    "keep more modes, or choose others",
                    modes.size(), wanted, n));
  }
  return modes;
}

std::vector<int> listed_modes(const Disc& disc, const std::vector<int>& numbers)
{
  const Motions motions = motions_of(disc);
  std::vector<int> modes;
  for (const int number : numbers) {
    if (number < 1 || number > disc.n_modes()) {
      throw Error(fmt::format("use_modes: there is no mode {}; the body has modes 1 to {}", number,
                              disc.n_modes()));
    }
    if (std::ranges::binary_search(motions.still, number - 1))
      throw Error(fmt::format("use_modes: mode {} does not move the ring along the axis", number));
    if (std::ranges::binary_search(motions.alternating, number - 1)) {
      throw Error(fmt::format(
          "use_modes: mode {} changes its sign from node to node of the ring, which shows one mode "
          "of such a pair only; choose other modes, or reduce the disc with more nodes on the ring",
          number));
    }
    modes.push_back(number - 1);
  }
  std::ranges::sort(modes);
  if (modes.empty() || std::ranges::adjacent_find(modes) != modes.end())
    throw Error("use_modes: the list is empty or names a mode twice");
  return modes;
}

ModeKind kind_of(const ModalBody& body, int i)
{
  const auto at = static_cast<std::size_t>(i);
  return at < body.kinds.size() ? body.kinds[at] : ModeKind::constrained;
}

/// Whether the disc has a vibration like this one. An interface mode stands for many. So does what
/// a reduction has beyond the modes of its certificate if it was made for responses: combinations
/// of the shapes that these needed.
bool is_of_disc(const ModalBody& body, int i)
{
  constexpr double same = 1e-6;
  if (kind_of(body, i) == ModeKind::interface) return false;
  const mbs_export::Certificate& known = body.certificate;
  if (!known.responses || known.fixed != body.fixed || known.frequencies.size() == 0) return true;
  return body.omega[i] <= (1.0 + same) * known.frequencies.maxCoeff();
}

/// What the scene says holds for all modes. Otherwise only what the disc does not do beyond the
/// range: a mode of the disc has its frequency there too.
ModeParts parts_of_all(const Disc& disc, const ModalBody& body, const ModeChoice& choice)
{
  ModeParts parts;
  const double limit = choice.quasi_static_above.value_or(range_of(body));
  const Motions motions = motions_of(disc);
  for (const int i : motions.moving) {
    const bool may = choice.quasi_static_above || !is_of_disc(body, i);
    (may && disc.omega[i] > limit ? parts.quasi_static : parts.dynamic).push_back(i);
  }
  parts.still = counted_from_one(motions.still);
  parts.alternating = counted_from_one(motions.alternating);
  if (parts.dynamic.empty() && parts.quasi_static.empty()) {
    throw Error(
        "each mode that moves the ring changes its sign from node to node, which shows one mode of "
        "such a pair only; reduce the disc with more nodes on the ring");
  }
  if (parts.dynamic.empty()) {
    throw Error(
        fmt::format("quasi_static_above_Hz: {:.6g} Hz leaves no mode with inertia; the lowest mode "
                    "that moves the ring has {:.6g} Hz",
                    limit / (2.0 * pi), disc.omega[parts.quasi_static.front()] / (2.0 * pi)));
  }
  return parts;
}

void check_elastic(const ModalBody& body, const std::vector<int>& modes)
{
  for (const int i : modes) {
    if (kind_of(body, i) == ModeKind::rigid || !(body.omega[i] > rigid_limit)) {
      throw Error(
          fmt::format("mode {} is a rigid-body motion ({:.3g} Hz): hold the disc, e.g. "
                      "fixed = [\"hub\"] in [body], or choose other modes",
                      i + 1, body.omega[i] / (2.0 * pi)));
    }
  }
}

/// The nodal diameters of a mode as the nodes of a ring show them, and as its slope along the ring
/// tells.
struct Diameters {
  int seen, told;
};

/// The number among `seen` + m N whose slopes are most like these. Those of a shell are smaller
/// than the slopes of its displacements, by its shear, never by much.
int told_by_slope(int seen, int n_nodes, double slope)
{
  int told = seen;
  double least = std::numeric_limits<double>::infinity();
  for (int m = -8; m <= 8; ++m) {
    const double ratio = slope / (seen + m * n_nodes);
    if (!(ratio > 0.4 && ratio < 1.3)) continue;
    const double distance = std::abs(std::log(ratio / 0.9));
    if (distance < least) {
      least = distance;
      told = seen + m * n_nodes;
    }
  }
  return std::abs(told);
}

/// Of the harmonic with most of the displacement; absent without displacement.
std::optional<Diameters> diameters_on(const DiscRing& ring, Eigen::Index mode, double limit)
{
  const Eigen::VectorXd cosine = ring.W.cosine.col(mode), sine = ring.W.sine.col(mode);
  const Eigen::VectorXd squares = cosine.cwiseAbs2() + sine.cwiseAbs2();
  Eigen::Index k = 0;
  const double most = squares.maxCoeff(&k);
  if (ring.n_nodes == 0 || most <= limit || 2.0 * most < squares.sum()) return std::nullopt;
  // W_t = 1/r dW/dtheta of W = cosine cos(k theta) + sine sin(k theta) as the ratio k of both.
  const double slope = ring.radius *
                       (sine[k] * ring.W_t.cosine(k, mode) - cosine[k] * ring.W_t.sine(k, mode)) /
                       most;
  const auto seen = static_cast<int>(k);
  return Diameters{.seen = seen, .told = told_by_slope(seen, ring.n_nodes, slope)};
}

/// A vibration of the disc in the band, not what stands for others.
/// @param end  of the band, rad/s
bool is_in_band(const ModalBody& body, int i, double end)
{
  return is_of_disc(body, i) && kind_of(body, i) != ModeKind::rigid && body.omega[i] <= end;
}

/// The diameters of the modes of a disc in the band on one ring, by their indices in the body.
std::map<int, Diameters> diameters_in_band(const Disc& disc, const DiscRing& ring,
                                           const ModalBody& body)
{
  const Eigen::VectorXd motion =
      (ring.W.cosine.cwiseAbs2() + ring.W.sine.cwiseAbs2()).colwise().sum().transpose();
  const double limit = still_limit * still_limit * (motion.size() > 0 ? motion.maxCoeff() : 0.0);
  const double end = std::min(range_of(body), end_of_known(disc, body));
  std::map<int, Diameters> found;
  for (std::size_t column = 0; column < disc.mode_numbers.size(); ++column) {
    const int i = disc.mode_numbers[column] - 1;
    const auto diameters = diameters_on(ring, Eigen::Index(column), limit);
    if (diameters && is_in_band(body, i, end)) found.emplace(i, *diameters);
  }
  for (const int number : disc.alternating)
    if (ring.n_nodes % 2 == 0 && is_in_band(body, number - 1, end))
      found.emplace(number - 1, Diameters{.seen = ring.n_nodes / 2, .told = ring.n_nodes / 2});
  return found;
}

}  // namespace

void refuse_aliases(const Disc& disc, const ModalBody& body)
{
  for (const DiscRing& ring : disc.rings) {
    const std::map<int, Diameters> found = diameters_in_band(disc, ring, body);
    const auto first = std::ranges::find_if(
        found, [&](const auto& mode) { return 2 * mode.second.told > ring.n_nodes; });
    if (ring.n_nodes == 0 || first == found.end()) continue;
    int most = 0;
    for (const auto& [i, diameters] : found) most = std::max(most, diameters.told);
    const auto& [i, diameters] = *first;
    throw Error(
        fmt::format("ring \"{}\" has {} nodes, on which mode {} ({:.1f} Hz) of {} nodal diameters "
                    "looks like one "
                    "of {}: n diameters need 2 n + 2 nodes, the {} of the modes kept {}; give the "
                    "ring {} nodes "
                    "or more, keep fewer modes in [body], or choose modes with use_modes",
                    ring.name, ring.n_nodes, i + 1, body.omega[i] / (2.0 * pi), diameters.told,
                    diameters.seen, most, 2 * most + 2, 2 * most + 2));
  }
}

double end_of_known(const Disc& disc, const ModalBody& body)
{
  constexpr double same = 1e-3;
  if (disc.errors.range > 0.0) return (1.0 + same) * disc.errors.range;
  const int n_all = body.preparation.n_constrained_modes;
  const bool has_all = n_all > 0 && body.n_modes() >= n_all;
  return has_all ? 0.5 * disc.omega.maxCoeff() : std::numeric_limits<double>::infinity();
}

double range_of(const ModalBody& body)
{
  double range = 0.0, others = 0.0;
  for (int i = 0; i < std::ssize(body.kinds); ++i) {
    double& highest = is_of_disc(body, i) ? range : others;
    highest = std::max(highest, body.omega[i]);
  }
  if (others == 0.0 || range == 0.0) return std::numeric_limits<double>::infinity();
  return body.selection ? body.selection->Omega_max : range;
}

ModeParts mode_parts(const Disc& disc, const ModalBody& body, const ModeChoice& choice)
{
  if (choice.nodal_diameters && choice.list)
    throw Error("use_modes: either nodal diameters or a list, not both");
  ModeParts parts;
  if (choice.nodal_diameters)
    parts.dynamic = modes_with_nodal_diameters(disc, *choice.nodal_diameters);
  else if (choice.list)
    parts.dynamic = listed_modes(disc, *choice.list);
  else
    parts = parts_of_all(disc, body, choice);
  check_elastic(body, parts.dynamic);
  return parts;
}

}  // namespace chladni::squeal
