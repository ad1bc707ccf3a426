#include "mesh/quality.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

namespace {

using CornerPositions = std::vector<Vector>;

constexpr double degree = std::numbers::pi / 180.0;

Vector mean(const Vector& a, const Vector& b)
{
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

/// Between 0 and pi; that of a zero vector is 0.
double angle(const Vector& a, const Vector& b)
{
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

CornerPositions corner_positions(const Mesh& mesh, const ElementBlock& block, int element)
{
  CornerPositions x;
  for (const int k : corner_places(block))
    x.push_back(mesh.positions[block.element_nodes(element)[k]]);
  return x;
}

/// An area vector a_1 x a_2 at a node, and its scale |a_1| |a_2|; on a triangle the greatest such
/// product of two of the three directions of its edges.
struct AreaVector {
  Vector n;
  double scale;
};

std::vector<AreaVector> area_vectors(const Mesh& mesh, const ElementBlock& block, int element,
                                     const ShapeDerivatives& d)
{
  std::vector<AreaVector> vectors;
  for (int i = 0; i < d.n_points(); ++i) {
    const auto [a_1, a_2] = tangents(mesh, block.element_nodes(element), d, i);
    const double third = block.shape == Shape::triangle ? norm(minus(a_2, a_1)) : 0.0;
    const double scale = std::max({norm(a_1) * norm(a_2), norm(a_1) * third, norm(a_2) * third});
    vectors.push_back({.n = cross(a_1, a_2), .scale = scale});
  }
  return vectors;
}

Vector sum_of(const std::vector<AreaVector>& vectors)
{
  Vector sum{};
  for (const AreaVector& v : vectors)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += v.n[c];
  return sum;
}

/// Signed by a mean normal, which a folded part of the element turns against.
double least_sine(const std::vector<AreaVector>& vectors, const Vector& mean)
{
  double least = std::numeric_limits<double>::infinity();
  for (const AreaVector& v : vectors) {
    // Tangents of 1e-12 of an element's size are none.
    const double sine = v.scale > 1e-24 * norm(mean) ? norm(v.n) / v.scale : 0.0;
    least = std::min(least, dot(v.n, mean) > 0.0 ? sine : -sine);
  }
  return least;
}

/// The derivatives at the points where the elements of a block are looked at.
struct PlacesOfBlock {
  ShapeDerivatives nodes, gauss;
  explicit PlacesOfBlock(const ElementBlock& block)
      : nodes(node_derivatives(block.shape, block.order)),
        gauss(gauss_derivatives(block.shape, block.order))
  {}
};

double scaled_jacobian(const Mesh& mesh, const ElementBlock& block, int element,
                       const PlacesOfBlock& at)
{
  const std::vector<AreaVector> vectors = area_vectors(mesh, block, element, at.nodes);
  const Vector mean = sum_of(vectors);
  const double best = block.shape == Shape::triangle ? std::sqrt(3.0) / 2.0 : 1.0;
  const double least = std::min(least_sine(vectors, mean) / best, 1.0);
  // A bilinear Jacobian that is positive at the corners is so inside.
  const double inside =
      block.order > 1 ? least_sine(area_vectors(mesh, block, element, at.gauss), mean) : 1.0;
  return inside > 0.0 ? least : std::min(least, inside);
}

double aspect_ratio(const CornerPositions& x)
{
  if (x.size() == 4) {
    const double a = norm(minus(mean(x[1], x[2]), mean(x[0], x[3])));
    const double b = norm(minus(mean(x[2], x[3]), mean(x[0], x[1])));
    return std::max(a, b) / std::min(a, b);
  }
  const double longest =
      std::max({norm(minus(x[1], x[0])), norm(minus(x[2], x[1])), norm(minus(x[0], x[2]))});
  const double twice_area = norm(cross(minus(x[1], x[0]), minus(x[2], x[0])));
  return longest * longest / twice_area * std::sqrt(3.0) / 2.0;
}

double warp(const CornerPositions& x)
{
  if (x.size() == 3) return 0.0;
  const auto normal = [&](int a, int b, int c) {
    return cross(minus(x[b], x[a]), minus(x[c], x[a]));
  };
  return std::max(angle(normal(0, 1, 2), normal(0, 2, 3)),
                  angle(normal(1, 2, 3), normal(1, 3, 0))) /
         degree;
}

double skew(const CornerPositions& x)
{
  const std::size_t n = x.size();
  const double ideal = n == 3 ? std::numbers::pi / 3.0 : std::numbers::pi / 2.0;
  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double at = angle(minus(x[(i + 1) % n], x[i]), minus(x[(i + n - 1) % n], x[i]));
    worst = std::max({worst, (at - ideal) / (std::numbers::pi - ideal), (ideal - at) / ideal});
  }
  return worst;
}

}  // namespace

std::vector<ElementQuality> quality(const Mesh& mesh)
{
  std::vector<ElementQuality> elements;
  for (const ElementBlock& block : mesh.blocks) {
    if (!is_surface(block.shape)) continue;
    const PlacesOfBlock places(block);
    for (int e = 0; e < block.n_elements(); ++e) {
      const CornerPositions x = corner_positions(mesh, block, e);
      elements.push_back({.number = block.numbers[e],
                          .scaled_jacobian = scaled_jacobian(mesh, block, e, places),
                          .aspect_ratio = aspect_ratio(x),
                          .warp = warp(x),
                          .skew = skew(x)});
    }
  }
  return elements;
}

std::vector<std::int64_t> unusable(const std::vector<ElementQuality>& elements)
{
  std::vector<std::int64_t> numbers;
  for (const ElementQuality& e : elements) {
    // Round-off of a corner of 180 degrees is no angle; so does not-a-number fail.
    if (!(e.scaled_jacobian > 1e-9)) numbers.push_back(e.number);
  }
  return numbers;
}

namespace {

/// A surface element of a mesh.
struct ElementOfMesh {
  int block, element;
  auto operator<=>(const ElementOfMesh&) const = default;
};

using Pair = std::pair<ElementOfMesh, ElementOfMesh>;

Pair ordered(const ElementOfMesh& a, const ElementOfMesh& b)
{
  return a < b ? Pair{a, b} : Pair{b, a};
}

std::span<const int> nodes_of_element(const Mesh& mesh, const ElementOfMesh& of)
{
  return mesh.blocks[std::size_t(of.block)].element_nodes(of.element);
}

bool have_the_same_nodes(const Mesh& mesh, const ElementOfMesh& a, const ElementOfMesh& b)
{
  return a.block == b.block &&
         std::ranges::is_permutation(nodes_of_element(mesh, a), nodes_of_element(mesh, b));
}

/// An element at one of its edges, which the node at one end and the next on it name.
struct SideOfEdge {
  int node, next;
  ElementOfMesh element;
  Vector inward;
};

/// All of them, those of an edge side by side. Both ends of an edge see it; the lower node counts.
std::vector<SideOfEdge> sides_of_edges(const Mesh& mesh)
{
  std::vector<SideOfEdge> sides;
  for (int b = 0; b < int(mesh.blocks.size()); ++b) {
    const ElementBlock& block = mesh.blocks[std::size_t(b)];
    if (!is_surface(block.shape)) continue;
    const ShapeDerivatives derivatives = node_derivatives(block.shape, block.order);
    const std::vector<int> lattice = corners_first(block.shape, block.order);
    for (int e = 0; e < block.n_elements(); ++e) {
      std::set<std::pair<int, int>> lower;  // (node, next)
      for (const std::vector<int>& edge : edges_of(block, e)) {
        const bool is_front = edge.front() < edge.back();
        lower.insert(is_front ? std::pair(edge.front(), edge[1])
                              : std::pair(edge.back(), edge[edge.size() - 2]));
      }
      for (std::size_t c = 0; c < std::size_t(n_corners(block.shape)); ++c) {
        const FaceAtNode face = face_at_node(mesh, block, e, lattice[c], derivatives);
        const int node = block.element_nodes(e)[std::size_t(lattice[c])];
        for (const EdgeAtNode& edge : face.edges) {
          if (lower.contains({node, edge.next})) {
            sides.push_back(
                {.node = node, .next = edge.next, .element = {b, e}, .inward = edge.inward});
          }
        }
      }
    }
  }
  std::ranges::sort(sides, {}, [](const SideOfEdge& side) {
    return std::tuple(side.node, side.next, side.element);
  });
  return sides;
}

/// Calls visit(sides) for each edge.
template <typename Visit>
void for_edges(const std::vector<SideOfEdge>& sides, const Visit& visit)
{
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t last = first + 1;
    const auto is_same = [&](const SideOfEdge& side) {
      return side.node == sides[first].node && side.next == sides[first].next;
    };
    while (last < sides.size() && is_same(sides[last])) ++last;
    visit(std::span(sides).subspan(first, last - first));
    first = last;
  }
}

/// The parts into which sharp edges divide the surfaces, and whether a part has an edge that no
/// other element shares.
class Parts {
 public:
  explicit Parts(const Mesh& mesh)
  {
    int n = 0;
    for (const ElementBlock& block : mesh.blocks) {
      first_.push_back(n);
      n += block.n_elements();
    }
    parent_.resize(std::size_t(n));
    std::iota(parent_.begin(), parent_.end(), 0);
    size_.assign(std::size_t(n), 1);
    is_open_.assign(std::size_t(n), 0);
  }
  void open(const ElementOfMesh& of) { is_open_[root(of)] = 1; }
  void join(const ElementOfMesh& a, const ElementOfMesh& b)
  {
    std::size_t to = root(a), from = root(b);
    if (to == from) return;
    if (size_[to] < size_[from]) std::swap(to, from);
    parent_[from] = int(to);
    size_[to] += size_[from];
    is_open_[to] = char(is_open_[to] | is_open_[from]);
  }
  /// One of a few elements that sharp edges enclose, beside the much larger part of another.
  bool is_enclosed_beside(const ElementOfMesh& few, const ElementOfMesh& many)
  {
    const std::size_t a = root(few), b = root(many);
    return a != b && is_open_[a] == 0 && 4 * size_[a] < size_[b];
  }

 private:
  std::size_t root(const ElementOfMesh& of)
  {
    auto at = std::size_t(first_[std::size_t(of.block)]) + std::size_t(of.element);
    while (std::size_t(parent_[at]) != at) {
      parent_[at] = parent_[std::size_t(parent_[at])];
      at = std::size_t(parent_[at]);
    }
    return at;
  }

  std::vector<int> first_, parent_, size_;
  std::vector<char> is_open_;
};

/// Neighbours that lie on one another.
std::set<Pair> folded_back(const Mesh& mesh)
{
  constexpr double flat = 179.0 * degree, sharp = 150.0 * degree;
  std::set<Pair> found;
  std::vector<Pair> sharp_edges;
  Parts parts(mesh);
  for_edges(sides_of_edges(mesh), [&](std::span<const SideOfEdge> sides) {
    if (sides.size() == 1) parts.open(sides[0].element);
    for (std::size_t b = 1; b < sides.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        const ElementOfMesh &one = sides[a].element, &other = sides[b].element;
        const double fold = fold_angle(sides[a].inward, sides[b].inward);
        if (fold < sharp || have_the_same_nodes(mesh, one, other)) {
          parts.join(one, other);
          continue;
        }
        sharp_edges.push_back(ordered(one, other));
        if (fold > flat) found.insert(ordered(one, other));
      }
    }
  });
  for (const auto& [a, b] : sharp_edges)
    if (parts.is_enclosed_beside(a, b) || parts.is_enclosed_beside(b, a)) found.insert({a, b});
  return found;
}

using PlanePoint = std::array<double, 2>;

/// An element in the plane of its group: its outline through the nodes of its edges.
struct Outline {
  ElementOfMesh element;
  std::vector<PlanePoint> points;
  PlanePoint low, high;  ///< corners of the box about it
};

/// The plane of the elements of a group, and two axes in it.
struct Plane {
  Vector origin, first, second;

  PlanePoint place(const Vector& x) const
  {
    return {dot(minus(x, origin), first), dot(minus(x, origin), second)};
  }
};

/// Absent where the nodes of a group do not lie in one plane.
std::optional<Plane> plane_of(const Mesh& mesh, const std::vector<ElementOfMesh>& elements)
{
  const ElementBlock& block = mesh.blocks[std::size_t(elements.front().block)];
  const auto [a_1, a_2] = tangents(mesh, nodes_of_element(mesh, elements.front()),
                                   node_derivatives(block.shape, block.order), 0);
  const Vector area = cross(a_1, a_2);
  if (!(norm(area) > 0.0)) return std::nullopt;
  const Plane plane{
      .origin = mesh.positions[std::size_t(nodes_of_element(mesh, elements.front())[0])],
      .first = unit(a_1),
      .second = cross(unit(area), unit(a_1))};
  double off = 0.0, size = 0.0;
  for (const ElementOfMesh& element : elements) {
    for (const int node : nodes_of_element(mesh, element)) {
      const Vector from = minus(mesh.positions[std::size_t(node)], plane.origin);
      off = std::max(off, std::abs(dot(from, unit(area))));
      size = std::max(size, norm(from));
    }
  }
  constexpr double flat = 1e-6;  // of the size; files have some seven digits
  return off <= flat * size ? std::optional(plane) : std::nullopt;
}

Outline outline_of(const Mesh& mesh, const ElementOfMesh& element, const Plane& plane)
{
  const ElementBlock& block = mesh.blocks[std::size_t(element.block)];
  std::vector<std::vector<int>> edges = edges_of(block, element.element);
  const bool is_triangle = block.shape == Shape::triangle;
  std::vector<std::size_t> around{0, 2, 1};
  if (!is_triangle) around = {0, 2, 3, 1};
  std::ranges::reverse(edges[1]);
  if (!is_triangle) std::ranges::reverse(edges[3]);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Outline outline{.element = element,
                  .points = {},
                  .low = {infinity, infinity},
                  .high = {-infinity, -infinity}};
  for (const std::size_t side : around) {
    for (std::size_t i = 0; i + 1 < edges[side].size(); ++i) {
      const PlanePoint x = plane.place(mesh.positions[std::size_t(edges[side][i])]);
      outline.points.push_back(x);
      for (std::size_t c = 0; c < 2; ++c) {
        outline.low[c] = std::min(outline.low[c], x[c]);
        outline.high[c] = std::max(outline.high[c], x[c]);
      }
    }
  }
  return outline;
}

/// By the number of sides that a ray from the point meets.
bool encloses(const Outline& outline, const PlanePoint& x)
{
  bool is_inside = false;
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const PlanePoint& a = outline.points[i];
    const PlanePoint& b = outline.points[(i + 1) % outline.points.size()];
    if ((a[1] > x[1]) == (b[1] > x[1])) continue;
    if (x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) is_inside = !is_inside;
  }
  return is_inside;
}

/// The middle of an element, and points halfway from there to the points of its outline.
std::vector<PlanePoint> inner_points(const Outline& outline)
{
  PlanePoint middle{};
  const auto n = static_cast<double>(outline.points.size());
  for (const PlanePoint& x : outline.points) middle = {middle[0] + x[0] / n, middle[1] + x[1] / n};
  std::vector<PlanePoint> points{middle};
  for (const PlanePoint& x : outline.points)
    points.push_back({0.5 * (x[0] + middle[0]), 0.5 * (x[1] + middle[1])});
  std::erase_if(points, [&](const PlanePoint& x) { return !encloses(outline, x); });
  return points;
}

/// The outlines by squares of a grid that their boxes meet.
class OutlineGrid {
 public:
  explicit OutlineGrid(const std::vector<Outline>& outlines) : outlines_(outlines)
  {
    double area = 0.0;
    for (const Outline& o : outlines)
      area += (o.high[0] - o.low[0]) * (o.high[1] - o.low[1]) / double(outlines.size());
    side_ = std::sqrt(area);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      const Square low = square(outlines[i].low), high = square(outlines[i].high);
      for (std::int64_t a = low[0]; a <= high[0]; ++a)
        for (std::int64_t b = low[1]; b <= high[1]; ++b) places_.push_back({{a, b}, i});
    }
    std::ranges::sort(places_);
  }
  /// Calls visit(outline) for those whose boxes may have this point.
  template <typename Visit>
  void for_near(const PlanePoint& x, const Visit& visit) const
  {
    const Square here = square(x);
    auto at = std::ranges::lower_bound(places_, here, {}, &Place::first);
    for (; at != places_.end() && at->first == here; ++at) visit(outlines_[at->second]);
  }

 private:
  using Square = std::array<std::int64_t, 2>;
  using Place = std::pair<Square, std::size_t>;

  Square square(const PlanePoint& x) const
  {
    return {std::llround(std::floor(x[0] / side_)), std::llround(std::floor(x[1] / side_))};
  }

  const std::vector<Outline>& outlines_;
  double side_ = 1.0;
  std::vector<Place> places_;
};

void add_overlaps_in_plane(const Mesh& mesh, const std::vector<ElementOfMesh>& elements,
                           std::set<Pair>& found)
{
  const std::optional<Plane> plane = plane_of(mesh, elements);
  if (!plane) return;
  std::vector<Outline> outlines;
  for (const ElementOfMesh& element : elements)
    outlines.push_back(outline_of(mesh, element, *plane));
  const OutlineGrid grid(outlines);
  for (const Outline& outline : outlines) {
    for (const PlanePoint& x : inner_points(outline)) {
      grid.for_near(x, [&](const Outline& other) {
        if (other.element == outline.element || !encloses(other, x)) return;
        if (!have_the_same_nodes(mesh, outline.element, other.element))
          found.insert(ordered(outline.element, other.element));
      });
    }
  }
}

/// "12, 15, 17, ...": the first ten.
std::string first_of(const std::vector<std::string>& all)
{
  const std::size_t n = std::min<std::size_t>(all.size(), 10);
  return fmt::format("{}{}", fmt::join(all.begin(), all.begin() + std::ptrdiff_t(n), ", "),
                     all.size() > n ? ", ..." : "");
}

}  // namespace

std::vector<Overlap> overlaps(const Mesh& mesh)
{
  std::set<Pair> found = folded_back(mesh);
  std::map<int, std::vector<ElementOfMesh>> of_group;
  for (int b = 0; b < int(mesh.blocks.size()); ++b) {
    const ElementBlock& block = mesh.blocks[std::size_t(b)];
    if (!is_surface(block.shape)) continue;
    for (int e = 0; e < block.n_elements(); ++e)
      of_group[block.group[std::size_t(e)]].push_back({b, e});
  }
  for (const auto& [group, elements] : of_group) add_overlaps_in_plane(mesh, elements, found);
  std::vector<Overlap> pairs;
  for (const auto& [a, b] : found) {
    const auto number = [&](const ElementOfMesh& of) {
      return mesh.blocks[std::size_t(of.block)].numbers[std::size_t(of.element)];
    };
    pairs.push_back(
        {.first = std::min(number(a), number(b)), .second = std::max(number(a), number(b))});
  }
  return pairs;
}

std::string complaint_about(const Mesh& mesh)
{
  std::vector<std::string> names;
  for (const std::int64_t number : unusable(quality(mesh)))
    names.push_back(fmt::format("{}", number));
  if (!names.empty()) {
    return fmt::format(
        "{} elements are degenerate or folded over (their Jacobian is not positive): {}; repair "
        "or refine the mesh there",
        names.size(), first_of(names));
  }
  for (const auto& [first, second] : overlaps(mesh))
    names.push_back(fmt::format("{} and {}", first, second));
  if (names.empty()) return "";
  return fmt::format(
      "{} pairs of elements lie on one another (one is turned over, or a surface was meshed "
      "twice): {}; repair the mesh there, or mesh it with another size or algorithm",
      names.size(), first_of(names));
}

void check_usable(const Mesh& mesh, const std::string& name)
{
  const std::string complaint = complaint_about(mesh);
  if (!complaint.empty()) throw Error(fmt::format("{}: {}", name, complaint));
}

}  // namespace chladni::mesh
