#include "squeal/brake/disc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/inertia.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/linear_contact.hpp"

namespace chladni::squeal {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;
using mbs_export::ModalBody, mbs_export::ModeKind;
using std::numbers::pi;

namespace {

/// int rho phi_i . (e_z x phi_j) dV when the body has the integrals, else zero.
Eigen::MatrixXd coriolis_of(const ModalBody& body)
{
  if (!body.mass_integrals) return Eigen::MatrixXd::Zero(body.n_modes(), body.n_modes());
  return 0.5 * mbs_export::gyroscopic_matrix(*body.mass_integrals, Eigen::Vector3d::UnitZ());
}

/// Of the constrained modes those of the body's certificate that have their frequencies, in order;
/// modes beyond it, and interface modes, which are no modes of the disc, have none.
Eigen::VectorXd errors_of(const ModalBody& body, const Eigen::VectorXd& certified)
{
  constexpr double same = 1e-6;
  if (certified.size() == 0 || body.certificate.fixed != body.fixed) return {};
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(body.n_modes());
  Eigen::Index next = 0;
  for (Eigen::Index i = 0; i < body.n_modes(); ++i) {
    if (body.kinds[static_cast<std::size_t>(i)] != mbs_export::ModeKind::constrained) continue;
    const auto& omega = body.certificate.frequencies;
    while (next < certified.size() && omega[next] < (1.0 - same) * body.omega[i]) ++next;
    if (next == certified.size()) break;
    if (omega[next] <= (1.0 + same) * body.omega[i]) errors[i] = certified[next++];
  }
  return errors;
}

/// [6 x n_modes]
Eigen::MatrixXd shape_errors_of(const ModalBody& body)
{
  const Eigen::MatrixXd& certified = body.certificate.mesh_shape_errors;
  Eigen::MatrixXd errors(certified.rows(), certified.rows() > 0 ? body.n_modes() : 0);
  for (Eigen::Index row = 0; row < errors.rows(); ++row) {
    const Eigen::VectorXd of_modes = errors_of(body, certified.row(row));
    if (of_modes.size() == 0) return {};
    errors.row(row) = of_modes;
  }
  return errors;
}

/// Whether a static force at a ring displaces it as it does the reduced system: by modes for
/// responses, or by all modes.
bool has_static_compliance(const ModalBody& body)
{
  using mbs_export::ModeKind;
  return std::ranges::count(body.kinds, ModeKind::interface) > 0 ||
         std::ranges::count(body.kinds, ModeKind::constrained) >=
             body.preparation.n_constrained_modes;
}

/// [3 x n_rings]
Eigen::MatrixXd mesh_compliances_of(const ModalBody& body, const std::vector<DiscRing>& rings)
{
  const mbs_export::OwnCompliances& own = body.certificate.mesh_compliances;
  if (!has_static_compliance(body) || body.certificate.fixed != body.fixed) return {};
  Eigen::MatrixXd growth(3, std::ssize(rings));
  for (Eigen::Index i = 0; i < growth.cols(); ++i) {
    const auto at = std::ranges::find(own.sets, rings[static_cast<std::size_t>(i)].name);
    if (at == own.sets.end()) return {};
    growth.col(i) = own.growth.col(at - own.sets.begin());
  }
  return growth;
}

ModeErrors mode_errors(const ModalBody& body, const std::vector<DiscRing>& rings)
{
  const Eigen::VectorXd& certified = body.certificate.frequencies;
  ModeErrors errors{.mesh = errors_of(body, body.certificate.mesh_errors),
                    .mesh_shapes = shape_errors_of(body),
                    .reduction = errors_of(body, mbs_export::estimated_errors(body.certificate)),
                    .responses = {},
                    .mesh_compliances = mesh_compliances_of(body, rings),
                    .n_harmonics = std::ssize(ring_harmonics(rings).c),
                    .range = certified.size() > 0 ? certified[certified.size() - 1] : 0.0};
  if (body.selection && !body.selection->with_interface_modes.empty()) {
    const mbs_export::SelectionTable& table = *body.selection;
    const double of_steps =
        std::min(table.with_interface_modes.back().error,
                 table.modes_only.empty() ? table.error : table.modes_only.back().error);
    errors.responses = of_steps + table.of_reduction.value_or(0.0);
  }
  return errors;
}

Disc disc_of_all_modes(const ModalBody& body, const RingChoice& choice)
{
  std::vector<DiscRing> rings;
  for (const std::string& name : choice.names) rings.push_back(disc_ring(body, name, choice));
  std::vector<int> numbers(static_cast<std::size_t>(body.n_modes()));
  std::iota(numbers.begin(), numbers.end(), 1);
  const Eigen::MatrixXd C =
      body.C.size() > 0 ? body.C : Eigen::MatrixXd::Zero(body.n_modes(), body.n_modes());
  return {.rings = rings,
          .mode_numbers = numbers,
          .omega = body.omega,
          .C = C,
          .G = coriolis_of(body),
          .errors = mode_errors(body, rings)};
}

Harmonics columns(const Harmonics& f, const std::vector<int>& modes)
{
  if (f.cosine.size() == 0) return {};
  return {f.cosine(every, modes), f.sine(every, modes)};
}

Eigen::VectorXd part(const Eigen::VectorXd& values, const std::vector<int>& modes)
{
  if (values.size() == 0) return {};
  return values(modes);
}

Eigen::MatrixXd columns_of(const Eigen::MatrixXd& values, const std::vector<int>& modes)
{
  if (values.size() == 0) return {};
  return values(every, modes);
}

Disc with_modes(const Disc& all, const std::vector<int>& modes)
{
  std::vector<int> numbers;
  numbers.reserve(modes.size());
  for (const int i : modes) numbers.push_back(all.mode_numbers[static_cast<std::size_t>(i)]);
  std::vector<DiscRing> rings;
  for (const DiscRing& ring : all.rings) {
    rings.push_back({ring.name, ring.radius, columns(ring.W, modes), columns(ring.W_r, modes),
                     columns(ring.W_t, modes), ring.n_nodes, columns(ring.V_r, modes),
                     columns(ring.V_t, modes), ring.height});
  }
  return {.rings = rings,
          .mode_numbers = numbers,
          .omega = all.omega(modes),
          .C = all.C(modes, modes),
          .G = all.G(modes, modes),
          .errors = {.mesh = part(all.errors.mesh, modes),
                     .mesh_shapes = columns_of(all.errors.mesh_shapes, modes),
                     .reduction = part(all.errors.reduction, modes),
                     .responses = all.errors.responses,
                     .mesh_compliances = all.errors.mesh_compliances,
                     .n_harmonics = all.errors.n_harmonics,
                     .range = all.errors.range}};
}

/// Of some modes those that the others leave without a partner, or with one that is too different.
std::vector<int> unpaired(const Disc& all, const std::vector<int>& modes)
{
  const Eigen::VectorXd shares = unpaired_shares(with_modes(all, modes));
  std::vector<int> found;
  for (Eigen::Index k = 0; k < shares.size(); ++k)
    if (shares[k] >= impurity_limit * impurity_limit)
      found.push_back(modes[static_cast<std::size_t>(k)]);
  return found;
}

/// Whether these modes are those of an axisymmetric disc, whatever their damping.
bool are_axisymmetric(const Disc& all, const std::vector<int>& modes)
{
  Disc disc = with_modes(all, modes);
  disc.C.setZero();
  return !asymmetry(disc);
}

/// Whether the body has what its reduction has, also where that knows no mode.
bool has_all_modes(const ModalBody& body)
{
  const int n_all = body.preparation.n_constrained_modes;
  return n_all > 0 && body.n_modes() >= n_all;
}

/// Modes beyond `end` follow the pads without inertia where the disc would not be axisymmetric with
/// them, and is without: a reduction has there what its shapes make of others. Those whose partners
/// are missing do first. Where the disc is not axisymmetric without them either, all modes of a
/// reduction would meet in equations over the rotation, whose size they set: those beyond follow.
void let_unpaired_follow(const Disc& all, const ModalBody& body, ModeParts& parts)
{
  const double end = end_of_known(all, body);
  std::vector<int> within, beyond;
  for (const int mode : parts.dynamic) (all.omega[mode] <= end ? within : beyond).push_back(mode);
  if (within.empty() || beyond.empty() || are_axisymmetric(all, parts.dynamic)) return;
  const bool is_axisymmetric = are_axisymmetric(all, within);
  if (!is_axisymmetric && !has_all_modes(body)) return;
  std::vector<int> alone = unpaired(all, parts.dynamic), paired;
  std::erase_if(alone, [&](int mode) { return all.omega[mode] <= end; });
  std::ranges::set_difference(parts.dynamic, alone, std::back_inserter(paired));
  const bool is_enough = is_axisymmetric && are_axisymmetric(all, paired);
  parts.alone = is_enough ? std::move(alone) : std::move(beyond);
  parts.dynamic = is_enough ? std::move(paired) : std::move(within);
  parts.quasi_static.insert(parts.quasi_static.end(), parts.alone.begin(), parts.alone.end());
  std::ranges::sort(parts.quasi_static);
}

}  // namespace

std::vector<int> nodal_diameters(const Disc& disc)
{
  const Eigen::MatrixXd motion = ring_harmonics(disc.rings).squares_by_harmonic();
  std::vector<int> n;
  for (Eigen::Index i = 0; i < motion.cols(); ++i) {
    Eigen::Index k = 0;
    motion.col(i).maxCoeff(&k);
    n.push_back(static_cast<int>(k));
  }
  return n;
}

Disc disc_on_ring(const ModalBody& body, const std::string& ring, const ModeChoice& modes)
{
  return make_disc(body, RingChoice{.names = {ring}}, modes);
}

std::vector<std::string> notes_of(const Disc& disc)
{
  std::vector<std::string> notes;
  if (!disc.compliance.empty()) {
    notes.push_back(fmt::format(
        "{} of the body's modes, from {:.5g} Hz on, follow the pads without inertia{}",
        disc.compliance.mode_numbers.size(), disc.compliance.lowest_omega / (2.0 * pi),
        disc.compliance.mode_numbers.size() > disc.alone.size() ? " (quasi_static_above_Hz)" : ""));
  }
  if (!disc.alone.empty()) {
    notes.push_back(fmt::format(
        "{} of these, beyond the frequencies that the reduction knows the errors of, lack the "
        "partner or the harmonic shape of a mode of the disc: they are none of its modes",
        disc.alone.size()));
  }
  if (!disc.still.empty()) {
    notes.push_back(fmt::format(
        "{} of the body's modes do not move the ring{} and take no part: {}", disc.still.size(),
        disc.rings.front().V_r.cosine.size() > 0 ? "" : " along the axis",
        fmt::join(disc.still, ", ")));
  }
  if (!disc.alternating.empty()) {
    notes.push_back(
        fmt::format("{} of the body's modes, whose sign changes from node to node of the ring, "
                    "take no part: {}; "
                    "a ring of more nodes would show both modes of such a pair",
                    disc.alternating.size(), fmt::join(disc.alternating, ", ")));
  }
  return notes;
}

std::optional<std::string> note_of_lacking_errors(const Disc& disc, const ModalBody& body,
                                                  const ModeChoice& choice)
{
  if (body.certificate.mesh_errors.size() == 0) return std::nullopt;
  if (disc.errors.mesh.size() == 0) {
    return fmt::format(
        "growth rates and critical speeds come without the errors of the mesh: the body knows them "
        "as held at [\"{}\"], and is held at [\"{}\"]",
        fmt::join(body.certificate.fixed, "\", \""), fmt::join(body.fixed, "\", \""));
  }
  if (disc.errors.mesh_compliances.size() > 0) return std::nullopt;
  const std::string why =
      choice.list || choice.nodal_diameters ? "use_modes leaves out the modes that have it"
      : !has_static_compliance(body)
          ? "the body keeps no shapes for static forces, as keep = { tolerance = ... } of [body] "
            "adds them"
          : "the body does not know it: that is computed for a held body with a table [squeal], up "
            "to 20,000 DOFs, or 200,000 of elements below order 4";
  return fmt::format(
      "the errors of growth rates and critical speeds lack what finer elements add to the "
      "compliance under the pads, since {}",
      why);
}

RingChoice ring_choice(const SquealOptions& options)
{
  RingChoice choice{.names = {options.ring},
                    .in_plane = options.planes.has_value(),
                    .slopes_from = options.slopes_from};
  const auto add = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names)
      if (!name.empty() && std::ranges::find(choice.names, name) == choice.names.end())
        choice.names.push_back(name);
  };
  if (options.planes) add({options.planes->opposite_ring});
  for (const PadPair& pad : options.pads) {
    if (!pad.grid) continue;
    add(pad.grid->rings);
    add(pad.grid->opposite_rings);
  }
  return choice;
}

std::vector<RingPlace> ring_places(const Disc& disc)
{
  std::vector<RingPlace> places;
  for (const DiscRing& ring : disc.rings) places.push_back({ring.name, ring.radius, ring.height});
  return places;
}

Disc make_disc(const ModalBody& body, const RingChoice& rings, const ModeChoice& choice)
{
  const Disc all = disc_of_all_modes(body, rings);
  if (!(ring_harmonics(all.rings).squares_by_harmonic().maxCoeff() > 0.0)) {
    throw Error(
        fmt::format("ring '{}': no mode of the body moves it{}; it is held, or the body has no "
                    "bending modes",
                    fmt::join(rings.names, "', '"), rings.in_plane ? "" : " along the axis"));
  }
  ModeParts parts = mode_parts(all, body, choice);
  const bool has_choice = choice.list || choice.nodal_diameters;
  if (!has_choice) let_unpaired_follow(all, body, parts);
  Disc disc = with_modes(all, parts.dynamic);
  if (has_choice) disc.errors.mesh_compliances = {};  // of what is left out
  disc.range = range_of(body);
  if (!parts.quasi_static.empty())
    disc.compliance = ring_compliance(with_modes(all, parts.quasi_static));
  disc.still = parts.still;
  disc.alternating = parts.alternating;
  for (const int i : parts.alone) disc.alone.push_back(i + 1);
  const std::vector<ModeFigure> figures = mode_figures(body, nodal_diameters(all));
  for (const int i : parts.dynamic) disc.figures.push_back(figures[static_cast<std::size_t>(i)]);
  return disc;
}

Shapes shapes_at(const Disc& disc, double theta)
{
  return shapes_at(disc.rings.front(), theta);
}

namespace {

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
  if (parts.dynamic.empty() && !choice.quasi_static_above) {
    throw Error(
        fmt::format("the body was made for responses up to {:.6g} Hz, below which no mode of the "
                    "disc moves the ring: the lowest one has {:.6g} Hz; raise up_to_Hz of [reduce] "
                    "and of keep in [body] well above it",
                    limit / (2.0 * pi), disc.omega[parts.quasi_static.front()] / (2.0 * pi)));
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

/// Parts of equal width of the radius; fewer where the picture has few points.
constexpr int parts_max = 16;
/// A part is looked at when it has so many points for each coefficient.
constexpr int points_per_coefficient = 4;
/// Amplitudes below this part of the largest one have no sign.
constexpr double still = 0.05;
/// Points of a picture by their distance from the axis.
struct Parts {
  std::vector<std::vector<Index>> points;
};

Parts parts_of(const mbs_export::Picture& picture, int diameters)
{
  if (picture.positions.rows() == 0) return {};
  const Eigen::VectorXd r = picture.positions.leftCols<2>().rowwise().norm();
  const double from = r.minCoeff(), to = r.maxCoeff();
  const auto needed = Index{points_per_coefficient} * (2 * diameters + 1);
  const auto n = std::clamp<Index>(r.size() / needed, 1, parts_max);
  Parts parts{std::vector<std::vector<Index>>(static_cast<std::size_t>(n))};
  for (Index i = 0; i < r.size(); ++i) {
    const auto at = static_cast<Index>((r[i] - from) / (to - from) * double(n));
    parts.points[static_cast<std::size_t>(std::clamp<Index>(at, 0, n - 1))].push_back(i);
  }
  std::erase_if(parts.points, [&](const auto& of) { return std::ssize(of) < 2 * diameters + 1; });
  return parts;
}

/// (a, b) of u_z = a cos(d theta) + b sin(d theta) by least squares over the points of a part.
Eigen::Vector2d amplitude(const mbs_export::Picture& picture, const std::vector<Index>& points,
                          Index mode, int d)
{
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Index i : points) {
    const double theta = d * std::atan2(picture.positions(i, 1), picture.positions(i, 0));
    const Eigen::Vector2d wave{std::cos(theta), std::sin(theta)};
    A += wave * wave.transpose();
    right += picture.transformation(3 * i + 2, mode) * wave;
  }
  if (d == 0) return {right[0] / A(0, 0), 0.0};
  return linear::least_squares(A, right);
}

/// The points of a picture at the height of a ring, with the motion of a mode.
mbs_export::Picture plane_of(const mbs_export::Picture& picture, Index mode, const DiscRing& ring)
{
  std::vector<Index> points;
  for (Index i = 0; i < picture.positions.rows(); ++i)
    if (std::abs(picture.positions(i, 2) - ring.height) < 1e-3 * ring.radius) points.push_back(i);
  mbs_export::Picture plane{.positions = picture.positions(points, every),
                            .cells = {},
                            .transformation = Eigen::MatrixXd(3 * std::ssize(points), 1)};
  for (Index i = 0; i < std::ssize(points); ++i) {
    plane.transformation.block<3, 1>(3 * i, 0) =
        picture.transformation.block<3, 1>(3 * points[static_cast<std::size_t>(i)], mode);
  }
  return plane;
}

/// How much of the squared motion along the axis is that of harmonic d, over all points.
double share_of(const mbs_export::Picture& picture, int d)
{
  double explained = 0.0, all = 0.0;
  for (const std::vector<Index>& points : parts_of(picture, d).points) {
    const Eigen::Vector2d a = amplitude(picture, points, 0, d);
    for (const Index i : points) {
      const double theta = d * std::atan2(picture.positions(i, 1), picture.positions(i, 0));
      const double u = picture.transformation(3 * i + 2, 0);
      const double rest = u - a[0] * std::cos(theta) - a[1] * std::sin(theta);
      explained += u * u - rest * rest;
      all += u * u;
    }
  }
  return all > 0.0 ? explained / all : 0.0;
}

/// The number among `seen` + m N whose harmonic has most of the motion of the mesh at the height of
/// the ring, for nodes that have no slope of their own, as those of solids.
int told_by_picture(const mbs_export::Picture& plane, int seen, int n_nodes)
{
  constexpr double clearly = 1.5;
  int told = seen;
  double most = clearly * share_of(plane, seen);
  for (const int d : {n_nodes - seen, n_nodes + seen, 2 * n_nodes - seen}) {
    const double share = d == seen ? 0.0 : share_of(plane, d);
    if (share <= most) continue;
    most = share;
    told = d;
  }
  return told;
}

/// Whether the nodes of a ring rotate by themselves.
bool has_slopes(const ModalBody& body, const std::string& ring)
{
  const auto at = std::ranges::find(body.rings, ring, &mbs_export::ContactRing::name);
  return at == body.rings.end() || at->W_r.norm() + at->W_t.norm() > 0.0;
}

bool has_picture(const ModalBody& body)
{
  return body.picture.positions.rows() > 0 && body.picture.transformation.cols() == body.n_modes();
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
  const bool is_drawn = has_picture(body), has_own_slopes = has_slopes(body, ring.name);
  std::map<int, Diameters> found;
  for (std::size_t column = 0; column < disc.mode_numbers.size(); ++column) {
    const int i = disc.mode_numbers[column] - 1;
    auto diameters = diameters_on(ring, Eigen::Index(column), limit);
    if (!diameters || !is_in_band(body, i, end)) continue;
    if (is_drawn && (!has_own_slopes || diameters->told != diameters->seen)) {
      const mbs_export::Picture plane = plane_of(body.picture, i, ring);
      if (!has_own_slopes)
        diameters->told = told_by_picture(plane, diameters->seen, ring.n_nodes);
      else if (share_of(plane, diameters->seen) > share_of(plane, diameters->told))
        diameters->told = diameters->seen;  // a rib turns the nodes
    }
    found.emplace(i, *diameters);
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
  return has_all_modes(body) ? 0.5 * disc.omega.maxCoeff()
                             : std::numeric_limits<double>::infinity();
}

double range_of(const ModalBody& body)
{
  double range = 0.0, others = 0.0;
  for (int i = 0; i < std::ssize(body.kinds); ++i) {
    double& highest = is_of_disc(body, i) ? range : others;
    highest = std::max(highest, body.omega[i]);
  }
  if (others > 0.0 && body.selection) return body.selection->Omega_max;
  return others > 0.0 && range > 0.0 ? range : std::numeric_limits<double>::infinity();
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

namespace {

/// Of motion in the plane, from which on nodal circles of the other one say nothing.
constexpr double mostly_in_plane = 0.5;

std::optional<double> in_plane_of(const mbs_export::ModalBody& body, Index mode)
{
  if (!body.mass_integrals) return std::nullopt;
  const auto& S = body.mass_integrals->products;
  const double plane = S[0](mode, mode) + S[1](mode, mode), axis = S[2](mode, mode);
  return plane + axis > 0.0 ? std::optional(plane / (plane + axis)) : std::nullopt;
}

int circles_of(const mbs_export::Picture& picture, Index mode, int diameters)
{
  std::vector<Eigen::Vector2d> amplitudes;
  for (const std::vector<Index>& points : parts_of(picture, diameters).points)
    amplitudes.push_back(amplitude(picture, points, mode, diameters));
  if (amplitudes.empty()) return 0;
  const Eigen::Vector2d largest =
      *std::ranges::max_element(amplitudes, {}, [](const Eigen::Vector2d& a) { return a.norm(); });
  int circles = 0;
  double last = 0.0;
  for (const Eigen::Vector2d& a : amplitudes) {
    const double along = a.dot(largest);
    if (std::abs(along) <= still * largest.squaredNorm()) continue;
    circles += along * last < 0.0 ? 1 : 0;
    last = along;
  }
  return circles;
}

}  // namespace

std::vector<ModeFigure> mode_figures(const mbs_export::ModalBody& body,
                                     const std::vector<int>& diameters)
{
  const bool is_drawn = has_picture(body);
  std::vector<ModeFigure> figures;
  for (Index i = 0; i < body.n_modes(); ++i) {
    ModeFigure figure{.in_plane = in_plane_of(body, i)};
    if (is_drawn && figure.in_plane.value_or(0.0) < mostly_in_plane)
      figure.circles = circles_of(body.picture, i, diameters[static_cast<std::size_t>(i)]);
    figures.push_back(figure);
  }
  return figures;
}

namespace {

using Complex = std::complex<double>;

/// Of the commutation with the stiffness against the motion of the rings, whose mean square is 1.
/// Much less lets modes of like harmonics and other frequencies mix, much more forbids what a mesh
/// without symmetry needs.
constexpr double commutation_weight = 1.0;

constexpr int iterations_max = 2000;
constexpr double iteration_error = 1e-15;

/// What the least squares minimise: S P + P S + weight o S = 2 Q for skew S and Q.
struct SkewProblem {
  MatrixXd P, Q, weight;

  MatrixXd apply(const MatrixXd& S) const
  {
    const MatrixXd SP = S * P;
    return SP - SP.transpose() + weight.cwiseProduct(S);
  }
};

SkewProblem skew_problem(const RingHarmonics& harmonics, const VectorXd& omega)
{
  const Eigen::Index n = omega.size();
  SkewProblem problem{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd(n, n)};
  for (std::size_t d = 0; d < harmonics.c.size(); ++d) {
    // S c / d = i c: else a little of harmonic 35 beside harmonic 1, which 36 vanes bring about and
    // which turns the other way, would weigh more than harmonic 1.
    const double by_d = 1.0 / std::max(1.0, double(d));
    const MatrixXd a = harmonics.c[d].real(), b = -harmonics.c[d].imag();
    problem.P += by_d * by_d * (a * a.transpose() + b * b.transpose());
    problem.Q += double(d) * by_d * by_d * (b * a.transpose() - a * b.transpose());
  }
  const double mean = std::max(problem.P.trace() / double(n), 1e-300);
  problem.P /= mean;
  problem.Q /= mean;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const double ratio = omega[i] / omega[j] - omega[j] / omega[i];
      problem.weight(i, j) = 2.0 * commutation_weight * ratio * ratio;
    }
  return problem;
}

/// Conjugate gradients with the diagonal as preconditioner.
MatrixXd solve(const SkewProblem& problem)
{
  const Eigen::Index n = problem.P.rows();
  const VectorXd p = problem.P.diagonal();
  const MatrixXd diagonal =
      (p.replicate(1, n) + p.transpose().replicate(n, 1) + problem.weight).cwiseMax(1e-14);
  MatrixXd S = MatrixXd::Zero(n, n), r = 2.0 * problem.Q, z = r.cwiseQuotient(diagonal), along = z;
  double rz = r.cwiseProduct(z).sum();
  const double small = iteration_error * iteration_error * rz;
  for (int i = 0; i < iterations_max && rz > small; ++i) {
    const MatrixXd A_along = problem.apply(along);
    const double step = rz / along.cwiseProduct(A_along).sum();
    S += step * along;
    r -= step * A_along;
    z = r.cwiseQuotient(diagonal);
    const double next = r.cwiseProduct(z).sum();
    along = z + (next / rz) * along;
    rz = next;
  }
  return 0.5 * (S - S.transpose());
}

/// The real space that complex columns and their conjugates span: its projector is real.
MatrixXcd real_basis(const MatrixXcd& E)
{
  const MatrixXd projector = (E * E.adjoint()).real();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
      MatrixXd(0.5 * (projector + projector.transpose())));
  return solver.eigenvectors().rightCols(E.cols()).cast<Complex>();
}

}  // namespace

VectorXd RingHarmonics::squares() const
{
  return squares_by_harmonic().colwise().sum().transpose();
}

MatrixXd RingHarmonics::squares_by_harmonic() const
{
  MatrixXd all(static_cast<Eigen::Index>(c.size()), c.front().rows());
  for (std::size_t d = 0; d < c.size(); ++d)
    all.row(static_cast<Eigen::Index>(d)) = c[d].cwiseAbs2().rowwise().sum().transpose();
  return all;
}

RingHarmonics ring_harmonics(const std::vector<DiscRing>& rings)
{
  Eigen::Index n_orders = 0;
  const Eigen::Index n_modes = rings.front().W.cosine.cols();
  for (const DiscRing& ring : rings) n_orders = std::max(n_orders, ring.n_whole_harmonics());
  const auto n_columns =
      static_cast<Eigen::Index>(functions_of(rings.front()).size() * rings.size());
  RingHarmonics all{std::vector<MatrixXcd>(static_cast<std::size_t>(n_orders),
                                           MatrixXcd::Zero(n_modes, n_columns))};
  Eigen::Index column = 0;
  for (const DiscRing& ring : rings)
    for (const auto& [f, scale] : functions_of(ring)) {
      for (Eigen::Index d = 0; d < ring.n_whole_harmonics(); ++d) {
        all.c[static_cast<std::size_t>(d)].col(column) =
            scale * (f->cosine.row(d) - Complex(0.0, 1.0) * f->sine.row(d)).transpose();
      }
      ++column;
    }
  return all;
}

MatrixXd rotation_generator(const RingHarmonics& harmonics, const VectorXd& omega)
{
  return solve(skew_problem(harmonics, omega));
}

std::vector<HarmonicSpace> harmonic_spaces(const MatrixXd& S)
{
  const Eigen::SelfAdjointEigenSolver<MatrixXcd> solver(
      MatrixXcd(Complex(0.0, -1.0) * S.cast<Complex>()));
  const VectorXd& sigma = solver.eigenvalues();
  std::vector<HarmonicSpace> spaces;
  for (Eigen::Index first = 0; first < sigma.size();) {
    const long d = std::lround(sigma[first]);
    Eigen::Index last = first;
    while (last < sigma.size() && std::lround(sigma[last]) == d) ++last;
    const MatrixXcd E = solver.eigenvectors().middleCols(first, last - first);
    if (d >= 0) spaces.push_back({static_cast<int>(d), d == 0 ? real_basis(E) : E});
    first = last;
  }
  return spaces;
}

}  // namespace chladni::squeal
