#include "squeal/brake/disc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/mass_integrals.hpp"
#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/mode_parts.hpp"
#include "squeal/brake/rotation_generator.hpp"

namespace chladni::squeal {
namespace {

using mbs_export::ContactRing;
using mbs_export::ModalBody;
using std::numbers::pi;

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

Harmonics columns(const Harmonics& f, const std::vector<int>& modes)
{
  return {f.cosine(every, modes), f.sine(every, modes)};
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
  const Eigen::MatrixXd motion = ring_harmonics(disc.rings).squares_by_harmonic();
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
  if (!(ring_harmonics(all.rings).squares_by_harmonic().maxCoeff() > 0.0))
    throw Error(
        fmt::format("ring '{}': no mode of the body moves it along the axis; it is held, or "
                    "the body has no bending modes",
                    fmt::join(names, "', '")));
  const ModeParts parts = mode_parts(all, body, choice);
  Disc disc = with_modes(all, parts.dynamic);
  disc.range = range_of(body);
  if (!parts.quasi_static.empty())
    disc.compliance = ring_compliance(with_modes(all, parts.quasi_static));
  disc.still = parts.still;
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
