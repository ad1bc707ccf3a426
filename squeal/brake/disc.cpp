#include "squeal/brake/disc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "common/error.hpp"
#include "mbs_export/mass_integrals.hpp"
#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/rotation_generator.hpp"

namespace chladni::squeal {
namespace {

using mbs_export::ContactRing;
using mbs_export::ModalBody;
using mbs_export::ModeKind;
using std::numbers::pi;

/// Below this angular frequency (0.1 Hz) a mode counts as a rigid-body motion, rad/s.
constexpr double rigid_limit = 0.2 * pi;

/// Ring motion below this part of the largest one, a 4e-6th of its kinetic energy, is that of a
/// mode in the plane of the disc: rounding of the FE model, or what a hat or vanes make of torsion.
constexpr double still_limit = 2e-3;

/// Modes of bodies with interface modes have no inertia so far beyond the range.
constexpr double quasi_static_multiple = 1.5;

/// Angles of a mesh are known to about 1e-9; beyond this the nodes are not equally spaced, rad.
constexpr double angle_limit = 1e-5;

void check_ring(const ModalBody& body, const ContactRing& ring)
{
  const auto n = static_cast<Eigen::Index>(ring.angles.size());
  if (n < 3 || !(ring.radius > 0.0))
    throw Error(fmt::format("ring '{}': {} nodes at radius {} m; it needs 3 nodes and a radius > 0",
                            ring.name, n, ring.radius));
  for (const Eigen::MatrixXd* values : {&ring.W, &ring.W_r, &ring.W_t})
    if (values->rows() != n || values->cols() != body.n_modes())
      throw Error(fmt::format("ring '{}': shapes are [{} x {}], expected [{} x {}]", ring.name,
                              values->rows(), values->cols(), n, body.n_modes()));
  if (ring.W.norm() > 0.0 && ring.W_r.norm() + ring.W_t.norm() == 0.0)
    throw Error(fmt::format(
        "ring '{}': its nodes move along the axis and do not rotate, but friction acts on the disc "
        "through its slopes; reduce it with the rotations of these nodes among the coordinates",
        ring.name));
}

DiscRing ring_of(const ModalBody& body, const std::string& name)
{
  const ContactRing& ring = mbs_export::find_ring(body, name);
  check_ring(body, ring);
  return {.name = name,
          .radius = ring.radius,
          .W = harmonics_of(ring.angles, ring.W),
          .W_r = harmonics_of(ring.angles, ring.W_r),
          .W_t = harmonics_of(ring.angles, ring.W_t),
          .n_nodes = static_cast<int>(ring.angles.size())};
}

/// int rho phi_i . (e_z x phi_j) dV when the body has the integrals, else zero.
Eigen::MatrixXd coriolis_of(const ModalBody& body)
{
  if (!body.mass_integrals) return Eigen::MatrixXd::Zero(body.n_modes(), body.n_modes());
  return 0.5 * mbs_export::gyroscopic_matrix(*body.mass_integrals, Eigen::Vector3d::UnitZ());
}

Disc disc_of_all_modes(const ModalBody& body, const std::vector<std::string>& names)
{
  std::vector<DiscRing> rings;
  for (const std::string& name : names) rings.push_back(ring_of(body, name));
  std::vector<int> numbers(static_cast<std::size_t>(body.n_modes()));
  std::iota(numbers.begin(), numbers.end(), 1);
  const Eigen::MatrixXd C =
      body.C.size() > 0 ? body.C : Eigen::MatrixXd::Zero(body.n_modes(), body.n_modes());
  return {
      .rings = rings, .mode_numbers = numbers, .omega = body.omega, .C = C, .G = coriolis_of(body)};
}

/// Squared amplitude of each harmonic of each mode on all rings, slopes multiplied by the radius.
Eigen::MatrixXd ring_motion(const Disc& disc)
{
  return ring_harmonics(disc.rings).squares_by_harmonic();
}

/// 0-based modes that move the ring along the axis.
std::vector<int> moving_modes(const Disc& disc)
{
  const Eigen::VectorXd motion = ring_motion(disc).colwise().sum().transpose().cwiseSqrt();
  std::vector<int> modes;
  for (int i = 0; i < motion.size(); ++i)
    if (motion[i] > still_limit * motion.maxCoeff()) modes.push_back(i);
  return modes;
}

/// 1-based, of the others.
std::vector<int> still_modes(const Disc& disc)
{
  const std::vector<int> moving = moving_modes(disc);
  std::vector<int> still;
  for (int i = 0; i < disc.n_modes(); ++i)
    if (!std::ranges::binary_search(moving, i)) still.push_back(i + 1);
  return still;
}

std::vector<int> modes_with_nodal_diameters(const Disc& disc, int n)
{
  const std::vector<int> diameters = nodal_diameters(disc);
  const std::size_t wanted = n == 0 ? 1 : 2;
  std::vector<int> modes;
  for (const int i : moving_modes(disc))
    if (diameters[i] == n && modes.size() < wanted) modes.push_back(i);
  if (modes.size() < wanted)
    throw Error(
        fmt::format("use_modes: the body has {} of the {} modes with {} nodal diameters; "
                    "keep more modes, or choose others",
                    modes.size(), wanted, n));
  return modes;
}

std::vector<int> listed_modes(const Disc& disc, const std::vector<int>& numbers)
{
  const std::vector<int> moving = moving_modes(disc);
  std::vector<int> modes;
  for (const int number : numbers) {
    if (number < 1 || number > disc.n_modes())
      throw Error(fmt::format("use_modes: there is no mode {}; the body has modes 1 to {}", number,
                              disc.n_modes()));
    if (std::find(moving.begin(), moving.end(), number - 1) == moving.end())
      throw Error(fmt::format("use_modes: mode {} does not move the ring along the axis", number));
    modes.push_back(number - 1);
  }
  std::sort(modes.begin(), modes.end());
  if (modes.empty() || std::adjacent_find(modes.begin(), modes.end()) != modes.end())
    throw Error("use_modes: the list is empty or names a mode twice");
  return modes;
}

/// Which 0-based modes of a body are what.
struct Parts {
  std::vector<int> dynamic, quasi_static;
};

/// The end of the range for which a body with interface modes was made, rad/s: that of a tolerance,
/// or of the modes that were kept. Others say nothing of one: infinite.
double range_of(const ModalBody& body)
{
  double range = 0.0, interface = 0.0;
  for (std::size_t i = 0; i < body.kinds.size(); ++i) {
    double& highest = body.kinds[i] == ModeKind::interface ? interface : range;
    highest = std::max(highest, body.omega[static_cast<Eigen::Index>(i)]);
  }
  if (interface == 0.0 || range == 0.0) return std::numeric_limits<double>::infinity();
  return body.selection ? body.selection->Omega_max : range;
}

Parts parts_of_all(const Disc& disc, const ModalBody& body, const ModeChoice& choice)
{
  Parts parts;
  const double limit = choice.quasi_static_above.value_or(quasi_static_multiple * range_of(body));
  for (const int i : moving_modes(disc))
    (disc.omega[i] > limit ? parts.quasi_static : parts.dynamic).push_back(i);
  if (parts.dynamic.empty())
    throw Error(
        fmt::format("quasi_static_above_Hz: {:.6g} Hz leaves no mode with inertia; the lowest mode "
                    "that moves the ring has {:.6g} Hz",
                    limit / (2.0 * pi), disc.omega[parts.quasi_static.front()] / (2.0 * pi)));
  return parts;
}

Parts chosen_parts(const Disc& disc, const ModalBody& body, const ModeChoice& choice)
{
  if (choice.nodal_diameters && choice.list)
    throw Error("use_modes: either nodal diameters or a list, not both");
  if (choice.nodal_diameters)
    return {modes_with_nodal_diameters(disc, *choice.nodal_diameters), {}};
  if (choice.list) return {listed_modes(disc, *choice.list), {}};
  return parts_of_all(disc, body, choice);
}

void check_elastic(const ModalBody& body, const std::vector<int>& modes)
{
  for (const int i : modes) {
    const auto at = static_cast<std::size_t>(i);
    const bool rigid = at < body.kinds.size() && body.kinds[at] == ModeKind::rigid;
    if (rigid || !(body.omega[i] > rigid_limit))
      throw Error(
          fmt::format("mode {} is a rigid-body motion ({:.3g} Hz): hold the disc, e.g. "
                      "fixed = [\"hub\"] in [body], or choose other modes",
                      i + 1, body.omega[i] / (2.0 * pi)));
  }
}

Harmonics columns(const Harmonics& f, const std::vector<int>& modes)
{
  return {f.cosine(Eigen::all, modes), f.sine(Eigen::all, modes)};
}

Disc with_modes(const Disc& all, const std::vector<int>& modes)
{
  std::vector<int> numbers;
  numbers.reserve(modes.size());
  for (const int i : modes) numbers.push_back(all.mode_numbers[static_cast<std::size_t>(i)]);
  std::vector<DiscRing> rings;
  for (const DiscRing& ring : all.rings)
    rings.push_back({ring.name, ring.radius, columns(ring.W, modes), columns(ring.W_r, modes),
                     columns(ring.W_t, modes), ring.n_nodes});
  return {.rings = rings,
          .mode_numbers = numbers,
          .omega = all.omega(modes),
          .C = all.C(modes, modes),
          .G = all.G(modes, modes)};
}

}  // namespace

Harmonics harmonics_of(const Eigen::VectorXd& angles, const Eigen::MatrixXd& values)
{
  const Eigen::Index n = angles.size();
  for (Eigen::Index j = 0; j < n; ++j)
    if (!(std::abs(angles[j] - angles[0] - 2.0 * pi * double(j) / double(n)) < angle_limit))
      throw Error(
          fmt::format("ring node {} of {} is at {:.6f} rad: the nodes of a contact ring must "
                      "be equally spaced, in the order of their angles",
                      j + 1, n, angles[j]));
  Harmonics f{Eigen::MatrixXd(n / 2 + 1, values.cols()), Eigen::MatrixXd(n / 2 + 1, values.cols())};
  for (Eigen::Index k = 0; k <= n / 2; ++k) {
    // Through harmonic n / 2 only one function can be told: cos(k (theta - theta_0)).
    const bool single = k == 0 || 2 * k == n;
    const Eigen::ArrayXd phase = double(k) * (angles.array() - angles[0]);
    const double scale = (single ? 1.0 : 2.0) / double(n);
    const Eigen::RowVectorXd c = scale * phase.cos().matrix().transpose() * values;
    const Eigen::RowVectorXd s = (single ? 0.0 : scale) * phase.sin().matrix().transpose() * values;
    const double cos_0 = std::cos(double(k) * angles[0]), sin_0 = std::sin(double(k) * angles[0]);
    f.cosine.row(k) = c * cos_0 - s * sin_0;
    f.sine.row(k) = c * sin_0 + s * cos_0;
  }
  return f;
}

std::vector<int> nodal_diameters(const Disc& disc)
{
  const Eigen::MatrixXd motion = ring_motion(disc);
  std::vector<int> n;
  for (Eigen::Index i = 0; i < motion.cols(); ++i) {
    Eigen::Index k = 0;
    motion.col(i).maxCoeff(&k);
    n.push_back(static_cast<int>(k));
  }
  return n;
}

Disc make_disc(const ModalBody& body, const std::string& ring, const ModeChoice& modes)
{
  return make_disc(body, std::vector{ring}, modes);
}

std::vector<std::string> notes_of(const Disc& disc)
{
  std::vector<std::string> notes;
  if (!disc.compliance.empty())
    notes.push_back(fmt::format(
        "{} of the body's modes, from {:.5g} Hz on, follow the pads without inertia "
        "(quasi_static_above_Hz)",
        disc.compliance.mode_numbers.size(), disc.compliance.lowest_omega / (2.0 * pi)));
  if (!disc.still.empty())
    notes.push_back(fmt::format(
        "{} of the body's modes do not move the ring along the axis and take no part: {}",
        disc.still.size(), fmt::join(disc.still, ", ")));
  return notes;
}

std::vector<std::string> ring_names(const SquealOptions& options)
{
  std::vector<std::string> names{options.ring};
  for (const PadPair& pad : options.pads) {
    if (!pad.grid) continue;
    for (const std::string& name : pad.grid->rings)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<RingPlace> ring_places(const Disc& disc)
{
  std::vector<RingPlace> places;
  for (const DiscRing& ring : disc.rings) places.push_back({ring.name, ring.radius});
  return places;
}

Disc make_disc(const ModalBody& body, const std::vector<std::string>& names,
               const ModeChoice& choice)
{
  const Disc all = disc_of_all_modes(body, names);
  if (!(ring_motion(all).maxCoeff() > 0.0))
    throw Error(
        fmt::format("ring '{}': no mode of the body moves it along the axis; it is held, or "
                    "the body has no bending modes",
                    fmt::join(names, "', '")));
  const Parts parts = chosen_parts(all, body, choice);
  check_elastic(body, parts.dynamic);
  Disc disc = with_modes(all, parts.dynamic);
  disc.range = range_of(body);
  if (!parts.quasi_static.empty())
    disc.compliance = ring_compliance(with_modes(all, parts.quasi_static));
  if (!choice.nodal_diameters && !choice.list) disc.still = still_modes(all);
  return disc;
}

Shapes shapes_at(const DiscRing& ring, double theta)
{
  const Eigen::Index n_orders = ring.W.cosine.rows();
  const Eigen::ArrayXd phase =
      theta * Eigen::ArrayXd::LinSpaced(n_orders, 0.0, double(n_orders - 1));
  const Eigen::VectorXd c = phase.cos(), s = phase.sin();
  const auto at = [&](const Harmonics& f) -> Eigen::VectorXd {
    return f.cosine.transpose() * c + f.sine.transpose() * s;
  };
  return {at(ring.W), at(ring.W_r), at(ring.W_t)};
}

Shapes shapes_at(const Disc& disc, double theta)
{
  return shapes_at(disc.rings.front(), theta);
}

}  // namespace chladni::squeal
