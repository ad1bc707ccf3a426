#include "squeal/assembly/face.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "squeal/assembly/joints.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/brake/point_pair.hpp"
#include "squeal/numerics.hpp"

namespace chladni::squeal {

namespace {

/// A face lies on the disc when its nodes do to this part of its height, and within the rings when
/// it does to this part of their radius.
constexpr double touching = 1e-3, within = 1e-4;

std::string name_of_face(const FaceContact& contact, const Part& part)
{
  return fmt::format("\"{}.{}\" ({})", contact.face.part, contact.face.set, part.file);
}

/// Which contact plane all nodes of a face lie on.
double side_of(const FaceContact& contact, const Part& part, const DiscFaces& disc,
               const std::vector<int>& nodes, const std::string& key)
{
  const auto& [lower, upper] = disc.planes;
  const Eigen::RowVectorXd z = part.positions.row(2)(nodes);
  const double sigma = z.mean() > 0.5 * (lower + upper) ? 1.0 : -1.0;
  const double plane = sigma > 0.0 ? upper : lower;
  if (!disc.are_checked) return sigma;
  const Eigen::RowVectorXd gap = (sigma * (z.array() - plane) - contact.height).matrix();
  Eigen::Index worst = 0;
  const double most =
      contact.height > 0.0
          ? touching * contact.height
          : within * part.positions.topRows(2)(Eigen::all, nodes).colwise().norm().mean();
  if (gap.cwiseAbs().maxCoeff(&worst) <= most) return sigma;
  throw Error(fmt::format(
      "{}.face: {} does not touch the disc: with height = {:.6g} m its face {} by up to {:.6g} m "
      "(the contact plane is z = {:.6g} m, its nodes lie at z = {:.6g} to {:.6g} m); check "
      "position "
      "and rotation_deg of part \"{}\", its height, and that its mesh is in m",
      key, name_of_face(contact, part), contact.height,
      gap[worst] > 0.0 ? "is away from it" : "reaches into it", std::abs(gap[worst]), plane,
      z.minCoeff(), z.maxCoeff(), part.name));
}

bool at_one_height(const RingPlace& a, const RingPlace& b)
{
  return std::abs(a.height - b.height) <= within * std::max(a.radius, b.radius);
}

/// The rings of the surface that is nearest to a contact plane: all rings, or those of one of two
/// faces.
std::vector<std::size_t> rings_near(const std::vector<RingPlace>& rings, double plane)
{
  const RingPlace& nearest = *std::ranges::min_element(
      rings, {}, [&](const RingPlace& ring) { return std::abs(ring.height - plane); });
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rings.size(); ++i)
    if (at_one_height(rings[i], nearest)) found.push_back(i);
  return found;
}

/// Lagrange's polynomials through the radii of those of some rings that are nearest, at r.
Eigen::VectorXd ring_parts(const std::vector<RingPlace>& rings, std::vector<std::size_t> order,
                           double r)
{
  constexpr std::size_t n_used = 4;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return std::abs(rings[i].radius - r); });
  order.resize(std::min(n_used, order.size()));
  Eigen::VectorXd parts = Eigen::VectorXd::Zero(std::ssize(rings));
  for (const std::size_t j : order) {
    double part = 1.0;
    for (const std::size_t m : order)
      if (m != j) part *= (r - rings[m].radius) / (rings[j].radius - rings[m].radius);
    parts[static_cast<Eigen::Index>(j)] = part;
  }
  return parts;
}

void check_radius(const DiscFaces& disc, const std::vector<std::size_t>& rings, double r,
                  const std::string& what)
{
  const auto radius = [&](std::size_t i) { return disc.rings[i].radius; };
  const double inner = radius(std::ranges::min(rings, {}, radius));
  const double outer = radius(std::ranges::max(rings, {}, radius));
  const double beyond = std::max(inner - r, r - outer);
  if (beyond <= within * outer) return;
  throw Error(
      fmt::format("{} has a node at the radius {:.6g} m, {:.6g} m beyond the rings of the disc, "
                  "which lie at {:.6g} to {:.6g} m; name rings in squeal.rings that enclose it",
                  what, r, beyond, inner, outer));
}

/// A face around the z axis.
struct Angles {
  double middle;           ///< rad
  Eigen::VectorXd values;  ///< [n] rad, less than half a turn from the middle

  /// Whether it reaches farther than outlines are known: a quarter of a turn to each side.
  bool is_wide() const
  {
    return (values.array() - middle).abs().maxCoeff() > 0.5 * std::numbers::pi * (1.0 + within);
  }
};

/// Angles from that of the middle of the face on.
Angles angles_about_middle(const Eigen::Matrix3Xd& x)
{
  const Eigen::Vector3d mean = x.rowwise().mean();
  const double middle = std::atan2(mean[1], mean[0]), c = std::cos(middle), s = std::sin(middle);
  Eigen::VectorXd angles(x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    angles[i] = middle + std::atan2(c * x(1, i) - s * x(0, i), c * x(0, i) + s * x(1, i));
  return {middle, angles};
}

/// Areas of the nodes; none where all lie on one line or circle, and of wide faces.
void put_shares(std::vector<FaceNode>& nodes, const FaceContact& contact, bool is_wide,
                const std::string& what)
{
  const Eigen::Index n = std::ssize(nodes);
  Eigen::VectorXd r(n), angle(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    r[i] = nodes[static_cast<std::size_t>(i)].place.radius;
    angle[i] = nodes[static_cast<std::size_t>(i)].angle;
  }
  const Eigen::VectorXd areas = is_wide ? Eigen::VectorXd::Zero(n) : node_areas(r, angle);
  const double whole = areas.sum();
  const bool by_area = contact.shares == NodeShares::by_area;
  if (is_wide && by_area) {
    throw Error(fmt::format(
        "{} reaches more than a quarter of a turn to a side of its middle, so that its outline is "
        "not known; split its nodes into sets of one lining each, or give shares = \"equal\" with "
        "stiffness, damping and preload of the whole face",
        what));
  }
  if (!(whole > 0.0) && by_area) {
    throw Error(fmt::format(
        "{} has nodes on one line or circle alone, which enclose no area; give shares = \"equal\", "
        "or a set of nodes over the whole face",
        what));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    FaceNode& node = nodes[static_cast<std::size_t>(i)];
    node.share = by_area ? areas[i] / whole : 1.0 / double(n);
    node.area = node.share * whole;
  }
}

}  // namespace

DiscFaces disc_faces(const AssemblyOptions& options, const InertialDisc& disc)
{
  DiscFaces faces{.rings = ring_places(disc), .planes = {}, .are_checked = true};
  const auto [low, high] = std::ranges::minmax_element(faces.rings, {}, &RingPlace::height);
  for (auto ring = faces.rings.begin(); ring != faces.rings.end(); ++ring) {
    const auto same = std::find_if(faces.rings.begin(), ring, [&](const RingPlace& other) {
      return std::abs(other.radius - ring->radius) <= within * ring->radius &&
             at_one_height(other, *ring);
    });
    if (same != ring) {
      throw Error(fmt::format(
          "squeal.rings: \"{}\" and \"{}\" lie on one circle of radius {:.6g} m; name one of them",
          same->name, ring->name, ring->radius));
    }
    if (!at_one_height(*ring, *low) && !at_one_height(*ring, *high)) {
      throw Error(fmt::format(
          "squeal.rings: \"{}\" lies at z = {:.6g} m, between those at {:.6g} and {:.6g} m; an "
          "assembly takes rings of one surface, or of the two faces of a solid",
          ring->name, ring->height, low->height, high->height));
    }
  }
  if (!options.planes && !at_one_height(*low, *high)) {
    throw Error(fmt::format(
        "squeal.rings: \"{}\" and \"{}\" lie at z = {:.6g} and {:.6g} m, so that a thickness about "
        "their middle says nothing of the faces; give contact_planes in place of thickness",
        low->name, high->name, low->height, high->height));
  }
  const double middle = 0.5 * (low->height + high->height), half = 0.5 * options.thickness;
  faces.planes = options.planes.value_or(std::array{middle - half, middle + half});
  return faces;
}

std::vector<FaceNode> face_nodes(const FaceContact& contact, const Part& part,
                                 const DiscFaces& disc, const std::string& key)
{
  const std::vector<int>& set = nodes_of(part, contact.face.set, key + ".face");
  const std::string what = fmt::format("{}.face: {}", key, name_of_face(contact, part));
  // Points below it move by the tilt of the plate, too; they do not feel it turn about z.
  const bool tilts = contact.height > 0.0;
  require_components(part, contact.face.set, {true, true, true, tilts, tilts, false}, key + ".face",
                     "a face needs displacements and, above the contact plane, tilts: keep them in "
                     "the reduced system, or give it nodes of shells or rigid couplings, or those "
                     "of a solid in the contact plane with height = 0");
  const double sigma = side_of(contact, part, disc, set, key);
  const Eigen::Matrix3Xd x = part.positions(Eigen::seqN(0, 3), set);
  const Angles angles = angles_about_middle(x);
  const auto& [lower, upper] = disc.planes;
  const double plane = sigma > 0.0 ? upper : lower;
  const std::vector<std::size_t> rings = rings_near(disc.rings, plane);
  std::vector<FaceNode> nodes;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double r = std::hypot(x(0, i), x(1, i));
    if (disc.are_checked) check_radius(disc, rings, r, what);
    nodes.push_back({.node = set[static_cast<std::size_t>(i)],
                     .height = contact.height,
                     .angle = angles.values[i],
                     .sigma = sigma,
                     .place = {.radius = r,
                               .plane = plane - 0.5 * (lower + upper),
                               .distance = plane - disc.rings[rings.front()].height},
                     .share = 0.0,
                     .area = 0.0,
                     .ring_parts = ring_parts(disc.rings, rings, r)});
  }
  put_shares(nodes, contact, angles.is_wide(), what);
  return nodes;
}

Eigen::MatrixXd disc_shapes(const InertialDisc& disc, const FaceNode& node)
{
  Eigen::MatrixXd S;
  for (Eigen::Index j = 0; j < node.ring_parts.size(); ++j) {
    if (node.ring_parts[j] == 0.0) continue;
    const Eigen::MatrixXd of_ring =
        node.ring_parts[j] *
        matrix_of(shapes_at(disc, disc.rings[static_cast<std::size_t>(j)], node.angle));
    if (S.size() == 0)
      S = of_ring;
    else
      S += of_ring;
  }
  return S;
}

Eigen::MatrixX3d face_motion(const Part& part, const FaceNode& node)
{
  const Eigen::Vector3d down(0.0, 0.0, -node.sigma * node.height);
  const Eigen::MatrixXd motion = motion_at(part, node.node, part.positions.col(node.node) + down);
  const double c = std::cos(node.angle), s = std::sin(node.angle);
  Eigen::MatrixX3d polar(part.n_modes(), 3);
  polar.col(0) = c * motion.row(0) + s * motion.row(1);
  polar.col(1) = c * motion.row(1) - s * motion.row(0);
  polar.col(2) = motion.row(2);
  return polar;
}

namespace {

using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

double cross_product(const Point& a, const Point& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// One chain of the hull of points in ascending order, without its last point.
template <class Points>
Polygon chain_of(const Points& points)
{
  Polygon chain;
  for (const Point& p : points) {
    while (chain.size() > 1 &&
           cross_product(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0.0)
      chain.pop_back();
    chain.push_back(p);
  }
  chain.pop_back();
  return chain;
}

/// The convex hull, counterclockwise.
/// Source: Andrew, Information Processing Letters 9 (1979) 216.
Polygon hull_of(Polygon points)
{
  std::ranges::sort(points, [](const Point& a, const Point& b) {
    return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
  });
  Polygon hull = chain_of(points);
  std::ranges::reverse(points);
  const Polygon back = chain_of(points);
  hull.insert(hull.end(), back.begin(), back.end());
  return hull;
}

/// The part of a convex polygon that is nearer to `own` than to `other`.
Polygon nearer(const Polygon& polygon, const Point& own, const Point& other)
{
  const Point middle = 0.5 * (own + other), away = other - own;
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double d_a = away.dot(a - middle), d_b = away.dot(b - middle);
    if (d_a <= 0.0) part.push_back(a);
    if ((d_a < 0.0 && d_b > 0.0) || (d_a > 0.0 && d_b < 0.0))
      part.push_back(a + d_a / (d_a - d_b) * (b - a));
  }
  return part;
}

double area_of(const Polygon& polygon)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += 0.5 * cross_product(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

/// The integral of x over a polygon.
double moment_of_polygon(const Polygon& polygon)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += (a[0] + b[0]) * cross_product(a, b) / 6.0;
  }
  return sum;
}

/// Nodes in a plane, in which a polygon has some area.
struct Plane {
  Polygon points, hull;
  std::function<double(const Polygon&)> area;

  double whole() const { return area(hull); }
};

Plane plane_of(Polygon points, std::function<double(const Polygon&)> area)
{
  Polygon hull = hull_of(points);
  return {std::move(points), std::move(hull), std::move(area)};
}

/// What of the hull is nearer to each point than to the others.
Eigen::VectorXd cells(const Plane& plane)
{
  Eigen::VectorXd areas(std::ssize(plane.points));
  for (std::size_t i = 0; i < plane.points.size(); ++i) {
    Polygon cell = plane.hull;
    for (std::size_t j = 0; j < plane.points.size() && !cell.empty(); ++j)
      if (j != i) cell = nearer(cell, plane.points[i], plane.points[j]);
    areas[static_cast<Eigen::Index>(i)] = plane.area(cell);
  }
  return areas;
}

}  // namespace

Eigen::VectorXd node_areas(const Eigen::VectorXd& radii, const Eigen::VectorXd& angles)
{
  const double R = radii.mean();
  Polygon polar, straight;
  for (Eigen::Index i = 0; i < radii.size(); ++i) {
    polar.emplace_back(radii[i], R * angles[i]);
    straight.emplace_back(radii[i] * std::cos(angles[i]), radii[i] * std::sin(angles[i]));
  }
  if (polar.size() < 3) return Eigen::VectorXd::Zero(radii.size());
  // The integral of r dr dtheta.
  const Plane of_sector =
      plane_of(std::move(polar), [R](const Polygon& p) { return moment_of_polygon(p) / R; });
  const Plane of_plate = plane_of(std::move(straight), area_of);
  const Plane& taken = of_plate.whole() < of_sector.whole() ? of_plate : of_sector;
  // On a line rounding alone leaves some area.
  if (!(taken.whole() > 1e-9 * R * R)) return Eigen::VectorXd::Zero(radii.size());
  return cells(taken);
}

namespace {

constexpr int pad_rows = 3;  // (r, t, z)

/// What is more than at rest, on the disc and on the pad.
template <class Scalar>
Eigen::VectorX<Scalar> forces_at(const PadContact& pad, double sigma,
                                 const Eigen::VectorX<Scalar>& motion_and_rates, double speed)
{
  const Eigen::Index rows = motion_and_rates.size() / 2, n = rows - pad_rows;
  const PairVector<Scalar> g = motion_and_rates.head(rows), g_dot = motion_and_rates.tail(rows);
  RingMotion<Scalar> m = ring_motion(g, g_dot, 0);
  PlateMotion<Scalar>& plate = sigma > 0.0 ? m.upper : m.lower;
  plate = {g[n + 2], g_dot[n], g_dot[n + 1], g_dot[n + 2]};
  if (n == face_rows) {
    move_in_plane<Scalar>(m, plate, g.template segment<2>(middle_rows),
                          g_dot.template segment<2>(middle_rows));
  }
  const PadState<double> at_rest = pad_state(pad, RingMotion<double>{}, speed, sigma);
  const PadState<Scalar> state = pad_state(pad, m, speed, sigma);
  Eigen::VectorX<Scalar> F(rows);
  F.head(n) = face_forces(face_of(pad, sigma), m, state, at_rest, sigma).head(n);
  F.tail(pad_rows) << -state.f_r, at_rest.f_t - state.f_t, sigma * (state.S - at_rest.S);
  return F;
}

}  // namespace

FaceDerivatives face_derivatives(const PadContact& pad, double sigma, int rows, double speed)
{
  require_in_table(pad, speed);
  const Eigen::MatrixXd D = derivative_at_rest(
      [&](const Eigen::VectorXcd& y) -> Eigen::VectorXcd {
        return forces_at<std::complex<double>>(pad, sigma, y, speed);
      },
      Eigen::Index{2} * rows);
  return {D.leftCols(rows), D.rightCols(rows)};
}

}  // namespace chladni::squeal
