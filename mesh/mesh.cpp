#include "mesh/mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "common/error.hpp"
#include "mesh/element_types.hpp"

namespace chladni::mesh {

namespace {

/// Fowler-Noll-Vo hash, variant 1a, 64 bits.
class Fnv1a {
 public:
  template <typename T>
  void add(std::span<const T> values)
  {
    for (const std::byte b : std::as_bytes(values))
      state_ = (state_ ^ std::to_integer<std::uint64_t>(b)) * 1099511628211ULL;
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 14695981039346656037ULL;
};

}  // namespace

const Group& find_group(const Mesh& mesh, const std::string& name)
{
  const auto it = std::ranges::find(mesh.groups, name, &Group::name);
  if (it != mesh.groups.end()) return *it;
  std::vector<std::string> names;
  for (const Group& g : mesh.groups) names.push_back(g.name);
  throw Error(fmt::format("the mesh has no group \"{}\"; its groups are: {}", name,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

void drop_unused_nodes(Mesh& mesh, std::span<const std::string> kept)
{
  std::vector<int> renumbered(mesh.positions.size(), -1);
  for (const ElementBlock& block : mesh.blocks)
    for (const int node : block.nodes) renumbered[node] = 0;
  for (const Group& group : mesh.groups)
    if (std::ranges::find(kept, group.name) != kept.end())
      for (const int node : group.nodes) renumbered[node] = 0;
  for (const Equation& equation : mesh.equations)
    for (const Equation::Term& term : equation.terms) renumbered[term.node] = 0;
  int n = 0;
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] < 0) continue;
    mesh.positions[n] = mesh.positions[i];
    mesh.node_numbers[n] = mesh.node_numbers[i];
    renumbered[i] = n++;
  }
  mesh.positions.resize(n);
  mesh.node_numbers.resize(n);
  for (ElementBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = renumbered[node];
  for (Group& group : mesh.groups) {
    for (int& node : group.nodes) node = renumbered[node];
    std::erase(group.nodes, -1);
  }
  for (Equation& equation : mesh.equations)
    for (Equation::Term& term : equation.terms) term.node = renumbered[term.node];
}

std::string checksum(const Mesh& mesh)
{
  Fnv1a hash;
  hash.add(std::span(mesh.positions));
  for (const ElementBlock& block : mesh.blocks) hash.add(std::span(block.nodes));
  if (mesh.sectors.count > 1) hash.add(std::span(&mesh.sectors.count, 1));
  for (const FaceNode& on_face : mesh.face_nodes) {
    hash.add(std::span(on_face.nodes));
    hash.add(std::span(on_face.weights));
  }
  for (const Equation& equation : mesh.equations) {
    for (const auto& [node, component, factor] : equation.terms) {
      hash.add(std::span(&node, 1));
      hash.add(std::span(&component, 1));
      hash.add(std::span(&factor, 1));
    }
  }
  return fmt::format("{:016x}", hash.value());
}

namespace {

struct Nearest {
  int node;
  double distance;
};

/// @param z of the node, if that matters
Nearest nearest_node(const Mesh& mesh, double x, double y, const std::optional<double>& z)
{
  Nearest best{.node = -1, .distance = std::numeric_limits<double>::infinity()};
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const auto& p = mesh.positions[i];
    const double d = std::hypot(p[0] - x, p[1] - y, z ? p[2] - *z : 0.0);
    if (d < best.distance) best = {.node = i, .distance = d};
  }
  return best;
}

/// @throws chladni::Error when another node has the same x and y, and only z could tell them apart.
void check_only_one(const Mesh& mesh, const RingOptions& ring, const Nearest& found,
                    double tolerance)
{
  const auto& x = mesh.positions[found.node];
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const auto& p = mesh.positions[i];
    if (i == found.node || std::hypot(p[0] - x[0], p[1] - x[1]) > found.distance + tolerance)
      continue;
    throw Error(fmt::format(
        "ring \"{}\": nodes {} and {} both stand on its circle, at z = {:.6g} and {:.6g} m; say "
        "which with z = ... in the ring",
        ring.name, mesh.node_numbers[found.node], mesh.node_numbers[i], x[2], p[2]));
  }
}

/// Where the nodes of a ring belong, and those that are nearest.
struct Place {
  double angle, x, y;
  Nearest nearest;
};

std::vector<Place> places_of(const Mesh& mesh, const RingOptions& ring)
{
  std::vector<Place> places;
  for (int i = 0; i < ring.nodes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / ring.nodes;
    const double x = ring.radius * std::cos(angle), y = ring.radius * std::sin(angle);
    places.push_back({.angle = angle, .x = x, .y = y, .nearest = nearest_node(mesh, x, y, ring.z)});
  }
  return places;
}

bool holds_solids(const Mesh& mesh)
{
  return std::ranges::any_of(mesh.blocks,
                             [](const ElementBlock& block) { return is_solid(block.shape); });
}

void refuse_missing(const Mesh& mesh, const std::vector<Place>& places, const Place& missing,
                    const RingOptions& ring, double tolerance)
{
  const auto is_there = [&](const Place& place) { return place.nearest.distance <= tolerance; };
  throw Error(fmt::format(
      "ring \"{}\": {} of its {} nodes are there; no node of the mesh is within {:.2g} m of radius "
      "{} m, angle {:.6g} degrees (the nearest is {:.3g} m away); put {} points at equal angles "
      "from the x axis on that circle{}",
      ring.name, std::ranges::count_if(places, is_there), ring.nodes, tolerance, ring.radius,
      missing.angle * 180.0 / std::numbers::pi, missing.nearest.distance, ring.nodes,
      holds_solids(mesh) ? ", or say on = \"face\" in the ring" : ""));
}

/// The places that have a node: all of them, or, of a sector, those inside and at its edges.
/// @throws chladni::Error when a place has no node in any sector.
std::vector<Place> occupied(const Mesh& mesh, const std::vector<Place>& places,
                            const RingOptions& ring, double tolerance)
{
  if (ring.nodes % mesh.sectors.count != 0) {
    throw Error(
        fmt::format("ring \"{}\": its {} nodes do not repeat in {} sectors; take a multiple",
                    ring.name, ring.nodes, mesh.sectors.count));
  }
  const int n_each = ring.nodes / mesh.sectors.count;
  std::vector<bool> is_there(static_cast<std::size_t>(n_each), false);
  std::vector<Place> found;
  for (int i = 0; i < ring.nodes; ++i) {
    const Place& place = places[static_cast<std::size_t>(i)];
    if (place.nearest.distance > tolerance) continue;
    is_there[static_cast<std::size_t>(i % n_each)] = true;
    found.push_back(place);
  }
  const auto missing = std::ranges::find(is_there, false);
  if (missing != is_there.end()) {
    refuse_missing(mesh, places, places[static_cast<std::size_t>(missing - is_there.begin())], ring,
                   tolerance);
  }
  return found;
}

Group ring_group(Mesh& mesh, const RingOptions& ring)
{
  constexpr double of_spacing = 1e-3;  // no element is bent by that; a file of 8 digits needs 1e-7
  constexpr double round_off = 1e-9;   // of Gmsh's arcs and of a file with 16 digits
  const double tolerance = of_spacing * 2.0 * std::numbers::pi * ring.radius / ring.nodes;
  const std::vector<Place> places = occupied(mesh, places_of(mesh, ring), ring, tolerance);
  Group group{.name = ring.name, .dimension = 0, .nodes = {}};
  double largest_move = 0.0;
  for (const Place& place : places) {
    const int node = place.nearest.node;
    if (!ring.z) check_only_one(mesh, ring, place.nearest, tolerance);
    if (!mesh.matrices) {
      mesh.positions[node][0] = place.x;
      mesh.positions[node][1] = place.y;
      if (ring.z) mesh.positions[node][2] = *ring.z;
    }
    largest_move = std::max(largest_move, place.nearest.distance);
    group.nodes.push_back(node);
  }
  if (largest_move > round_off * ring.radius) {
    mesh.notes.push_back(
        mesh.matrices ? fmt::format("ring \"{}\": its nodes are {:.2g} m off the circle at most, "
                                    "and stay where the matrices have them",
                                    ring.name, largest_move)
                      : fmt::format("ring \"{}\": its nodes were moved onto the circle, by {:.2g} "
                                    "m at most",
                                    ring.name, largest_move));
  }
  return group;
}

/// A point of a face, by the functions of the face there.
struct FacePoint {
  const FreeFace* face;
  std::vector<double> N;
  double z;  ///< m
};

/// The faces of the solids that look along the z axis, within the radii of a ring.
class LevelFaces {
 public:
  LevelFaces(const Mesh& mesh, const RingOptions& ring);
  /// Those that a line along the axis through (x, y) meets.
  std::vector<FacePoint> at(double x, double y) const;
  /// The length of a side of a face between two of its nodes, m.
  double spacing(const FreeFace& face) const;

 private:
  std::optional<FacePoint> point_of(const FreeFace& face, double x, double y) const;
  Vector position(const FreeFace& face, const std::vector<double>& N) const;
  int order(const FreeFace& face) const { return mesh_.blocks[face.block].order; }

  struct Box {
    std::array<double, 2> low, high;
  };
  const Mesh& mesh_;
  std::vector<FreeFace> faces_;
  std::vector<Box> boxes_;
};

LevelFaces::LevelFaces(const Mesh& mesh, const RingOptions& ring) : mesh_(mesh)
{
  constexpr double level = 0.5;  // of the normal along the axis
  for (FreeFace& face : free_faces(mesh)) {
    const auto x = [&](std::size_t i) { return mesh.positions[std::size_t(face.nodes[i])]; };
    const std::size_t n_corners = face.nodes.size() / std::size_t(order(face));
    const Vector normal = cross(minus(x(2), x(0)), minus(x(n_corners - 1), x(1)));
    if (std::abs(normal[2]) <= level * norm(normal)) continue;
    Box box{.low = {x(0)[0], x(0)[1]}, .high = {x(0)[0], x(0)[1]}};
    for (std::size_t i = 1; i < face.nodes.size(); ++i) {
      for (std::size_t c = 0; c < 2; ++c) {
        box.low[c] = std::min(box.low[c], x(i)[c]);
        box.high[c] = std::max(box.high[c], x(i)[c]);
      }
    }
    const double size = std::hypot(box.high[0] - box.low[0], box.high[1] - box.low[1]);
    if (std::abs(std::hypot(x(0)[0], x(0)[1]) - ring.radius) > size + ring.width) continue;
    for (std::size_t c = 0; c < 2; ++c) {  // edges may be curved
      box.low[c] -= 0.1 * size;
      box.high[c] += 0.1 * size;
    }
    boxes_.push_back(box);
    faces_.push_back(std::move(face));
  }
}

Vector LevelFaces::position(const FreeFace& face, const std::vector<double>& N) const
{
  Vector x{};
  for (std::size_t i = 0; i < N.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      x[c] += N[i] * mesh_.positions[std::size_t(face.nodes[i])][c];
  return x;
}

double LevelFaces::spacing(const FreeFace& face) const
{
  const auto x = [&](std::size_t i) { return mesh_.positions[std::size_t(face.nodes[i])]; };
  return norm(minus(x(1), x(0))) / order(face);
}

/// By Newton's iteration for the parent coordinates.
std::optional<FacePoint> LevelFaces::point_of(const FreeFace& face, double x, double y) const
{
  constexpr int most_steps = 30;
  constexpr double step = 1e-4, converged = 1e-12, outside = 1e-7;
  const bool is_triangle = std::ssize(face.nodes) == 3 * order(face);
  const auto at = [&](double r, double s) {
    return position(face, face_functions(face.nodes.size(), order(face), r, s));
  };
  double r = is_triangle ? 1.0 / 3.0 : 0.0, s = r, change = 1.0;
  for (int i = 0; i < most_steps && change > converged; ++i) {
    const Vector by_r = minus(at(r + step, s), at(r - step, s)),
                 by_s = minus(at(r, s + step), at(r, s - step)), here = at(r, s);
    const double det = (by_r[0] * by_s[1] - by_r[1] * by_s[0]) / (2.0 * step);
    if (det == 0.0) return std::nullopt;
    const double dx = x - here[0], dy = y - here[1];
    const double dr = (dx * by_s[1] - dy * by_s[0]) / det, ds = (dy * by_r[0] - dx * by_r[1]) / det;
    r += dr;
    s += ds;
    change = std::max(std::abs(dr), std::abs(ds));
  }
  const double beyond =
      is_triangle ? std::max({-r, -s, r + s - 1.0}) : std::max(std::abs(r), std::abs(s)) - 1.0;
  if (!(change <= converged) || beyond > outside) return std::nullopt;
  std::vector<double> N = face_functions(face.nodes.size(), order(face), r, s);
  const double z = position(face, N)[2];
  return FacePoint{.face = &face, .N = std::move(N), .z = z};
}

std::vector<FacePoint> LevelFaces::at(double x, double y) const
{
  std::vector<FacePoint> points;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const auto& [low, high] = boxes_[i];
    if (x < low[0] || x > high[0] || y < low[1] || y > high[1]) continue;
    if (auto point = point_of(faces_[i], x, y)) points.push_back(*std::move(point));
  }
  return points;
}

/// A ring whose nodes follow faces.
class RingOnFaces {
 public:
  RingOnFaces(const Mesh& mesh, const RingOptions& ring)
      : ring_(ring), faces_(mesh, ring), spacing_(2.0 * std::numbers::pi * ring.radius / ring.nodes)
  {}

  /// The node at an angle (rad), at a position of which x and y are those of the angle.
  std::pair<FaceNode, Vector> at(double angle) const;

 private:
  FacePoint point(double x, double y) const;

  const RingOptions& ring_;
  LevelFaces faces_;
  double spacing_;  ///< m, of the nodes
};

/// @throws chladni::Error where the face of the ring is not, with the heights of those that are.
FacePoint RingOnFaces::point(double x, double y) const
{
  constexpr double plane = 1e-6;  // of the radius: rings of bodies lie at one height
  std::vector<FacePoint> found = faces_.at(x, y);
  std::vector<std::string> heights;
  const FacePoint* chosen = nullptr;
  bool is_only = true;
  for (const FacePoint& p : found) {
    heights.push_back(fmt::format("{:.6g}", p.z));
    if (ring_.z && std::abs(p.z - *ring_.z) > plane * ring_.radius) continue;
    if (chosen && std::abs(p.z - chosen->z) > plane * ring_.radius) is_only = false;
    if (!chosen) chosen = &p;
  }
  if (chosen && is_only) return *chosen;
  std::ranges::sort(heights);
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  const std::string there =
      heights.empty() ? "there is no face of solids there that looks along the z axis"
                      : fmt::format("the faces there are at z = {} m", fmt::join(heights, ", "));
  throw Error(fmt::format(
      "ring \"{}\": at radius {:.6g} m, angle {:.6g} degrees it needs a face{}, but {}{}",
      ring_.name, std::hypot(x, y), std::atan2(y, x) * 180.0 / std::numbers::pi,
      ring_.z ? fmt::format(" at z = {} m", *ring_.z) : "", there,
      heights.size() > 1 ? "; say which with z = ... in the ring"
                         : "; a ring needs a plane face all around"));
}

std::pair<FaceNode, Vector> RingOnFaces::at(double angle) const
{
  const double c = std::cos(angle), s = std::sin(angle);
  const Vector centre{ring_.radius * c, ring_.radius * s, 0.0};
  const FacePoint middle = point(centre[0], centre[1]);
  const double fine = 0.5 * faces_.spacing(*middle.face);
  const auto n_of = [&](double side) {
    constexpr double most = 24.0;
    return static_cast<int>(std::clamp(std::ceil(side / fine), 2.0, most));
  };
  const int n_r = ring_.width > 0.0 ? n_of(ring_.width) : 1,
            n_t = ring_.width > 0.0 ? n_of(spacing_) : 1;
  std::map<int, double> weights;
  double z = 0.0;
  for (int i = 0; i < n_r; ++i) {
    for (int j = 0; j < n_t; ++j) {  // the middles of equal rectangles, whose mean is the centre
      const double by_r = ring_.width * ((i + 0.5) / n_r - 0.5),
                   by_t = spacing_ * ((j + 0.5) / n_t - 0.5);
      const FacePoint p = point(centre[0] + by_r * c - by_t * s, centre[1] + by_r * s + by_t * c);
      for (std::size_t k = 0; k < p.N.size(); ++k)
        weights[p.face->nodes[k]] += p.N[k] / (n_r * n_t);
      z += p.z / (n_r * n_t);
    }
  }
  constexpr double none = 1e-13;  // of a node across the edge on which the point lies
  FaceNode node{.node = -1, .nodes = {}, .weights = {}};
  for (const auto& [of_face, weight] : weights) {
    if (std::abs(weight) < none) continue;
    node.nodes.push_back(of_face);
    node.weights.push_back(weight);
  }
  return {std::move(node), Vector{centre[0], centre[1], ring_.z.value_or(z)}};
}

Group ring_on_faces(Mesh& mesh, const RingOptions& ring)
{
  if (!holds_solids(mesh)) {
    throw Error(
        fmt::format("ring \"{}\": on = \"face\" is for faces of solids, and the mesh has none; "
                    "nodes of the mesh "
                    "must stand at its places",
                    ring.name));
  }
  const RingOnFaces faces(mesh, ring);
  Group group{.name = ring.name, .dimension = 0, .nodes = {}};
  std::int64_t number = std::ranges::max(mesh.node_numbers);
  for (int i = 0; i < ring.nodes; ++i) {
    auto [on_face, position] = faces.at(2.0 * std::numbers::pi * i / ring.nodes);
    on_face.node = mesh.n_nodes();
    group.nodes.push_back(on_face.node);
    mesh.positions.push_back(position);
    mesh.node_numbers.push_back(++number);
    mesh.face_nodes.push_back(std::move(on_face));
  }
  return group;
}

}  // namespace

void add_rings(Mesh& mesh, std::span<const RingOptions> rings)
{
  for (const RingOptions& ring : rings) {
    mesh.groups.push_back(ring.on == RingOn::face ? ring_on_faces(mesh, ring)
                                                  : ring_group(mesh, ring));
  }
}

}  // namespace chladni::mesh
