#include "squeal/brake/disc_ring.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/eigen_every.hpp"
#include "common/error.hpp"

namespace chladni::squeal {

using mbs_export::ContactRing, mbs_export::ModalBody;
using std::numbers::pi;

namespace {

/// Angles of a mesh are known to about 1e-9; beyond this the nodes are not equally spaced, rad.
constexpr double angle_limit = 1e-5;
/// Rings lie at one height when it is the same to this part of their radius.
constexpr double same_height = 1e-6;

void check_ring(const ModalBody& body, const ContactRing& ring)
{
  const auto n = static_cast<Eigen::Index>(ring.angles.size());
  if (n < 3 || !(ring.radius > 0.0)) {
    throw Error(fmt::format("ring '{}': {} nodes at radius {} m; it needs 3 nodes and a radius > 0",
                            ring.name, n, ring.radius));
  }
  for (const Eigen::MatrixXd* values : {&ring.W, &ring.W_r, &ring.W_t})
    if (values->rows() != n || values->cols() != body.n_modes()) {
      throw Error(fmt::format("ring '{}': shapes are [{} x {}], expected [{} x {}]", ring.name,
                              values->rows(), values->cols(), n, body.n_modes()));
    }
}

bool rotates(const ContactRing& ring)
{
  return ring.W.norm() == 0.0 || ring.W_r.norm() + ring.W_t.norm() > 0.0;
}

bool at_height_of(const ContactRing& a, const ContactRing& b)
{
  return std::abs(a.height - b.height) <= same_height * std::max(a.radius, b.radius);
}

/// Displacements in the plane, [n x n_modes] each.
struct InPlane {
  Eigen::MatrixXd radial, circumferential;
};

InPlane in_plane(const ModalBody& body, const ContactRing& ring)
{
  const Eigen::Index n = ring.angles.size();
  InPlane V{Eigen::MatrixXd::Zero(n, body.n_modes()), Eigen::MatrixXd::Zero(n, body.n_modes())};
  double norm = 0.0;
  for (Eigen::Index i = 0; i < n && std::ssize(ring.nodes) == n; ++i) {
    const Eigen::Index row = 6 * Eigen::Index{ring.nodes[static_cast<std::size_t>(i)]};
    if (row + 6 > body.attachment_modes.rows()) break;
    const auto u = body.attachment_modes.middleRows(row, 2);
    const double c = std::cos(ring.angles[i]), s = std::sin(ring.angles[i]);
    V.radial.row(i) = c * u.row(0) + s * u.row(1);
    V.circumferential.row(i) = c * u.row(1) - s * u.row(0);
    norm += u.squaredNorm();
  }
  if (!(norm > 0.0)) {
    throw Error(fmt::format(
        "ring '{}': the body has no in-plane displacements of its nodes, which contact_planes and "
        "rings of two heights need; reduce it with x and y of these nodes among the coordinates "
        "(interface.nodes = [\"{}\", ...] takes all DOFs), or give `ring` one ring in the middle "
        "surface and leave contact_planes out",
        ring.name, ring.name));
  }
  return V;
}

/// 1/r dW/dtheta
Harmonics along_the_ring(const Harmonics& W, double radius)
{
  Harmonics slope = W;
  for (Eigen::Index d = 0; d < W.cosine.rows(); ++d) {
    slope.cosine.row(d) = double(d) / radius * W.sine.row(d);
    slope.sine.row(d) = -double(d) / radius * W.cosine.row(d);
  }
  return slope;
}

/// Adds factor * f to the sum.
void add(Harmonics& sum, double factor, const Harmonics& f)
{
  sum.cosine += factor * f.cosine;
  sum.sine += factor * f.sine;
}

/// The rings of the choice beside `ring`, at its height.
std::vector<const ContactRing*> rings_beside(const ModalBody& body, const ContactRing& ring,
                                             const RingChoice& choice)
{
  std::vector<const ContactRing*> rings;
  for (const std::string& name : choice.slopes_from) {
    const ContactRing& beside = mbs_export::find_ring(body, name);
    check_ring(body, beside);
    if (name == ring.name || !at_height_of(beside, ring)) continue;
    if (beside.angles.size() != ring.angles.size()) {
      throw Error(fmt::format(
          "[squeal] slopes_from: ring \"{}\" has {} nodes, but \"{}\" beside it has {}; radial "
          "slopes are taken from rings with as many nodes",
          name, beside.angles.size(), ring.name, ring.angles.size()));
    }
    rings.push_back(&beside);
  }
  return rings;
}

/// dW/dr by the polynomial in r through the ring (first) and those beside it.
Harmonics across_rings(const std::vector<const ContactRing*>& rings)
{
  const double r = rings.front()->radius;
  Harmonics slope = harmonics_of(rings.front()->angles, 0.0 * rings.front()->W);
  double own = 0.0;
  for (std::size_t j = 1; j < rings.size(); ++j) {
    // L_j'(r) = 1 / (r_j - r) prod over other m of (r - r_m) / (r_j - r_m); all L' sum to zero.
    double weight = 1.0 / (rings[j]->radius - r);
    for (std::size_t m = 1; m < rings.size(); ++m)
      if (m != j) weight *= (r - rings[m]->radius) / (rings[j]->radius - rings[m]->radius);
    if (!std::isfinite(weight)) {
      throw Error(
          fmt::format("[squeal] slopes_from: two rings have the radius {:.6g} m at one "
                      "height; name rings of different radii",
                      rings[j]->radius));
    }
    add(slope, weight, harmonics_of(rings[j]->angles, rings[j]->W));
    own -= weight;
  }
  add(slope, own, harmonics_of(rings.front()->angles, rings.front()->W));
  return slope;
}

/// How the line to the ring of the other plane leans: -(v_r - v_r') / (z - z'). Absent without one.
std::optional<Harmonics> lean(const ModalBody& body, const ContactRing& ring,
                              const RingChoice& choice)
{
  const ContactRing* other = nullptr;
  for (const std::string& name : choice.names) {
    const ContactRing& candidate = mbs_export::find_ring(body, name);
    if (at_height_of(candidate, ring) || candidate.angles.size() != ring.angles.size()) continue;
    if (!other || std::abs(candidate.radius - ring.radius) < std::abs(other->radius - ring.radius))
      other = &candidate;
  }
  if (!choice.in_plane || !other) return std::nullopt;
  const double by_distance = -1.0 / (ring.height - other->height);
  Harmonics slope = harmonics_of(ring.angles, by_distance * in_plane(body, ring).radial);
  add(slope, -by_distance, harmonics_of(other->angles, in_plane(body, *other).radial));
  return slope;
}

Harmonics radial_slope(const ModalBody& body, const ContactRing& ring, const RingChoice& choice)
{
  std::vector<const ContactRing*> rings = rings_beside(body, ring, choice);
  if (!rings.empty()) {
    rings.insert(rings.begin(), &ring);
    return across_rings(rings);
  }
  if (auto leaning = lean(body, ring, choice)) return *leaning;
  throw Error(fmt::format(
      "ring '{}': its nodes move along the axis and do not rotate, but friction acts on the disc "
      "through its slopes{}; name rings beside it at z = {:.6g} m in [squeal] slopes_from, or "
      "reduce "
      "it with the rotations of these nodes among the coordinates",
      ring.name,
      choice.slopes_from.empty() ? "" : ", and no ring of slopes_from lies at its height",
      ring.height));
}

}  // namespace

Harmonics harmonics_of(const Eigen::VectorXd& angles, const Eigen::MatrixXd& values)
{
  const Eigen::Index n = angles.size();
  for (Eigen::Index j = 0; j < n; ++j)
    if (!(std::abs(angles[j] - angles[0] - 2.0 * pi * double(j) / double(n)) < angle_limit)) {
      throw Error(
          fmt::format("ring node {} of {} is at {:.6f} rad: the nodes of a contact ring must "
                      "be equally spaced, in the order of their angles",
                      j + 1, n, angles[j]));
    }
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

std::vector<RingFunction> functions_of(const DiscRing& ring)
{
  std::vector<RingFunction> functions{
      {&ring.W, 1.0}, {&ring.W_r, ring.radius}, {&ring.W_t, ring.radius}};
  if (ring.V_r.cosine.size() > 0) {
    functions.push_back({&ring.V_r, 1.0});
    functions.push_back({&ring.V_t, 1.0});
  }
  return functions;
}

DiscRing disc_ring(const ModalBody& body, const std::string& name, const RingChoice& choice)
{
  const ContactRing& ring = mbs_export::find_ring(body, name);
  check_ring(body, ring);
  DiscRing result{.name = name,
                  .radius = ring.radius,
                  .W = harmonics_of(ring.angles, ring.W),
                  .W_r = {},
                  .W_t = {},
                  .n_nodes = static_cast<int>(ring.angles.size()),
                  .height = ring.height};
  if (choice.slopes_from.empty() && rotates(ring)) {
    result.W_r = harmonics_of(ring.angles, ring.W_r);
    result.W_t = harmonics_of(ring.angles, ring.W_t);
  } else {
    result.W_r = radial_slope(body, ring, choice);
    result.W_t = along_the_ring(result.W, ring.radius);
  }
  if (choice.in_plane) {
    const InPlane V = in_plane(body, ring);
    result.V_r = harmonics_of(ring.angles, V.radial);
    result.V_t = harmonics_of(ring.angles, V.circumferential);
  }
  return result;
}

double mean_over_patch(int d, double patch)
{
  const double x = d * patch;
  constexpr double small = 1e-4;  // the next term of 1 - x^2 / 8 + x^4 / 192 is rounding
  return x < small ? 1.0 - x * x / 8.0 : 2.0 * std::cyl_bessel_j(1.0, x) / x;
}

Shapes shapes_at(const DiscRing& ring, double theta)
{
  const Eigen::Index n_orders = ring.W.cosine.rows();
  const Eigen::ArrayXd phase =
      theta * Eigen::ArrayXd::LinSpaced(n_orders, 0.0, double(n_orders - 1));
  const Eigen::VectorXd c = phase.cos(), s = phase.sin();
  const auto at = [&](const Harmonics& f) -> Eigen::VectorXd {
    if (f.cosine.size() == 0) return {};
    return f.cosine.transpose() * c + f.sine.transpose() * s;
  };
  return {at(ring.W), at(ring.W_r), at(ring.W_t), at(ring.V_r), at(ring.V_t)};
}

namespace {

/// Part of the largest coefficient of a function below which another one is rounding.
constexpr double negligible = 1e-15;

}  // namespace

RingShapes::RingShapes(const DiscRing& ring)
{
  const std::vector<RingFunction> functions = functions_of(ring);
  const auto n_functions = static_cast<Eigen::Index>(functions.size());
  shapes_.resize(ring.W.cosine.cols(), n_functions);
  const Eigen::Index n_orders = ring.W.cosine.rows(), n = ring.W.cosine.cols();
  Eigen::MatrixXd all(n_functions * n, 2 * n_orders);
  for (Eigen::Index j = 0; j < n_functions; ++j) {
    const Harmonics& f = *functions[static_cast<std::size_t>(j)].values;
    for (Eigen::Index k = 0; k < n_orders; ++k) {
      all.col(2 * k).segment(n * j, n) = f.cosine.row(k).transpose();
      all.col(2 * k + 1).segment(n * j, n) = f.sine.row(k).transpose();
    }
  }
  const Eigen::ArrayXd limit = negligible * all.cwiseAbs().rowwise().maxCoeff();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < n_orders; ++k) {
    const auto magnitude = all.middleCols(2 * k, 2).cwiseAbs().rowwise().maxCoeff().array();
    if (!(magnitude > limit).any()) continue;
    orders_.push_back(static_cast<int>(k));
    kept.insert(kept.end(), {2 * k, 2 * k + 1});
  }
  coefficients_ = all(every, kept);
  waves_.resize(coefficients_.cols());
}

const Eigen::MatrixXd& RingShapes::at(double theta)
{
  const double c_1 = std::cos(theta), s_1 = std::sin(theta);
  double c = 1.0, s = 0.0;
  int k = 0;
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    for (; k < orders_[i]; ++k) {
      const double next = c * c_1 - s * s_1;
      s = s * c_1 + c * s_1;
      c = next;
    }
    waves_[static_cast<Eigen::Index>(2 * i)] = c;
    waves_[static_cast<Eigen::Index>(2 * i + 1)] = s;
  }
  Eigen::Map<Eigen::VectorXd>(shapes_.data(), shapes_.size()).noalias() = coefficients_ * waves_;
  return shapes_;
}

}  // namespace chladni::squeal
