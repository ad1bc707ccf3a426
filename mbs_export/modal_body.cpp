#include "mbs_export/modal_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/error.hpp"
#include "mbs_export/attachment_dofs.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Eigen::VectorXd loss_factors(const ModalBody& body)
{
  if (body.H.size() == 0) return {};
  Eigen::VectorXd eta = Eigen::VectorXd::Zero(body.n_modes());
  for (Eigen::Index i = 0; i < eta.size(); ++i)
    if (body.omega[i] > 0.0) eta[i] = body.H(i, i) / (body.omega[i] * body.omega[i]);
  return eta;
}

const ContactRing& find_ring(const ModalBody& body, const std::string& name)
{
  const auto found = std::ranges::find(body.rings, name, &ContactRing::name);
  if (found != body.rings.end()) return *found;
  std::vector<std::string> names;
  for (const ContactRing& ring : body.rings) names.push_back("'" + ring.name + "'");
  throw Error(fmt::format(
      "no contact ring '{}'; there is {} (a ring is an attachment set of three or more nodes at "
      "equal angles on one circle about the z axis, with all six components)",
      name, names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

namespace {

using std::numbers::pi;
constexpr double placement = 1e-6;  // of angles in rad, of lengths relative to the radius

/// In [0, 2 pi); a round-off below zero is zero.
double angle_of(const Eigen::Vector3d& position)
{
  const double angle = std::atan2(position.y(), position.x());
  if (std::abs(angle) < placement * placement) return 0.0;
  return angle < 0.0 ? angle + 2.0 * pi : angle;
}

/// Whether all nodes of a ring have the rotations that slopes are taken from.
bool rotates(const ReducedSystem& reduced, const ContactRing& ring)
{
  return std::ranges::all_of(ring.nodes, [&](int node) {
    return has_component(reduced, node, 3) && has_component(reduced, node, 4);
  });
}

/// The geometry of a ring without its modes, when the set is one.
std::optional<ContactRing> ring_of(const ReducedSystem& reduced, const AttachmentSet& set)
{
  if (set.nodes.size() < 3) return std::nullopt;
  const auto position = [&](int node) {
    return reduced.attachment_nodes[static_cast<std::size_t>(node)].position;
  };
  ContactRing ring{.name = set.name,
                   .radius = position(set.nodes[0]).head<2>().norm(),
                   .height = position(set.nodes[0]).z(),
                   .nodes = set.nodes,
                   .angles = VectorXd(Index(set.nodes.size())),
                   .W = {},
                   .W_r = {},
                   .W_t = {}};
  std::ranges::sort(ring.nodes, {}, [&](int node) { return angle_of(position(node)); });
  const double step = 2.0 * pi / static_cast<double>(ring.nodes.size());
  for (Index i = 0; i < ring.angles.size(); ++i) {
    const int node = ring.nodes[static_cast<std::size_t>(i)];
    const Eigen::Vector3d X = position(node);
    ring.angles[i] = angle_of(X);
    const double expected = ring.angles[0] + static_cast<double>(i) * step;
    if (std::abs(X.head<2>().norm() - ring.radius) > placement * ring.radius ||
        std::abs(X.z() - ring.height) > placement * ring.radius ||
        std::abs(ring.angles[i] - expected) > placement || !has_component(reduced, node, 2))
      return std::nullopt;
  }
  return ring.radius > 0.0 ? std::optional(ring) : std::nullopt;
}

}  // namespace

std::vector<ContactRing> contact_rings(const ReducedSystem& reduced,
                                       const MatrixXd& attachment_modes)
{
  std::vector<ContactRing> rings;
  for (const AttachmentSet& set : reduced.sets) {
    std::optional<ContactRing> ring = ring_of(reduced, set);
    if (!ring) continue;
    const Index n = ring->angles.size(), n_modes = attachment_modes.cols();
    ring->W = ring->W_r = ring->W_t = MatrixXd::Zero(n, n_modes);
    const bool has_slopes = rotates(reduced, *ring);
    for (Index i = 0; i < n; ++i) {
      const auto rows = attachment_modes.middleRows(6 * ring->nodes[std::size_t(i)], 6);
      const double c = std::cos(ring->angles[i]), s = std::sin(ring->angles[i]);
      ring->W.row(i) = rows.row(2);
      if (!has_slopes) continue;
      ring->W_r.row(i) = s * rows.row(3) - c * rows.row(4);  // -theta . e_t
      ring->W_t.row(i) = c * rows.row(3) + s * rows.row(4);  // theta . e_r
    }
    rings.push_back(std::move(*ring));
  }
  return rings;
}

FourierCoefficients fourier_coefficients(const VectorXd& angles, const MatrixXd& values)
{
  const Index N = angles.size(), n_harmonics = N / 2 + 1;
  FourierCoefficients coefficients{MatrixXd(n_harmonics, values.cols()),
                                   MatrixXd(n_harmonics, values.cols())};
  for (Index n = 0; n < n_harmonics; ++n) {
    // At n = N / 2 the nodes cannot tell cosine from sine, so each carries half of the sum.
    const double weight = (n == 0 || 2 * n == N ? 1.0 : 2.0) / static_cast<double>(N);
    const Eigen::ArrayXd phase = static_cast<double>(n) * angles.array();
    coefficients.cosine.row(n) = weight * phase.cos().matrix().transpose() * values;
    coefficients.sine.row(n) = weight * phase.sin().matrix().transpose() * values;
  }
  return coefficients;
}

}  // namespace chladni::mbs_export
