#include "mesh/element_types.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <span>
#include <utility>

namespace chladni::mesh {

namespace {

/// Lattice place of column i and row j; the rows of a triangle grow shorter.
class Lattice {
 public:
  Lattice(Shape shape, int order) : p_(order), is_triangle_(shape == Shape::triangle) {}
  int operator()(int i, int j) const
  {
    return is_triangle_ ? j * (p_ + 1) - j * (j - 1) / 2 + i : j * (p_ + 1) + i;
  }

 private:
  int p_;
  bool is_triangle_;
};

std::vector<LatticeCell> line_cells(int p, int step)
{
  std::vector<LatticeCell> cells;
  for (int i = 0; i < p; i += step) cells.push_back({i, i + step, i + step, i + step});
  return cells;
}

std::vector<int> quadrilateral_order(int p)
{
  const auto place = [&](int i, int j) { return j * (p + 1) + i; };
  std::vector<int> order{place(0, 0), place(p, 0), place(p, p), place(0, p)};
  for (int i = 1; i < p; ++i) order.push_back(place(i, 0));
  for (int j = 1; j < p; ++j) order.push_back(place(p, j));
  for (int i = 1; i < p; ++i) order.push_back(place(i, p));
  for (int j = 1; j < p; ++j) order.push_back(place(0, j));
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p; ++i) order.push_back(place(i, j));
  return order;
}

/// The inner nodes, up to order 4, are a triangle of order p - 3.
std::vector<int> triangle_order(int p)
{
  const auto place = [&](int i, int j) { return j * (p + 1) - j * (j - 1) / 2 + i; };
  std::vector<int> order{place(0, 0), place(p, 0), place(0, p)};
  for (int i = 1; i < p; ++i) order.push_back(place(i, 0));
  for (int i = 1; i < p; ++i) order.push_back(place(p - i, i));
  for (int i = 1; i < p; ++i) order.push_back(place(0, p - i));
  if (p > 2) order.push_back(place(1, 1));
  if (p > 3) order.insert(order.end(), {place(2, 1), place(1, 2)});
  return order;
}

std::vector<int> line_order(int p)
{
  std::vector<int> order{0, p};
  for (int i = 1; i < p; ++i) order.push_back(i);
  return order;
}

}  // namespace

std::vector<LatticeCell> lattice_cells(const ElementBlock& block, int step)
{
  const int p = block.order;
  if (block.shape == Shape::line) return line_cells(p, step);
  const bool triangle = block.shape == Shape::triangle;
  const Lattice place(block.shape, p);
  std::vector<LatticeCell> cells;
  for (int j = 0; j < p; j += step) {
    for (int i = 0; i + (triangle ? j : 0) < p; i += step) {
      const int a = place(i, j), b = place(i + step, j), d = place(i, j + step);
      if (!triangle) {
        cells.push_back({a, b, place(i + step, j + step), d});
        continue;
      }
      cells.push_back({a, b, d, d});
      if (i + j + 2 * step > p) continue;
      const int c = place(i + step, j + step);
      cells.push_back({b, c, d, d});
    }
  }
  return cells;
}

namespace {

std::vector<std::vector<int>> places_of_solid_edges(Shape shape, int order);

std::vector<std::vector<int>> places_of_surface_edges(Shape shape, int p)
{
  const bool triangle = shape == Shape::triangle;
  const Lattice place(shape, p);
  std::vector<std::vector<int>> edges(triangle ? 3 : 4);
  for (int i = 0; i <= p; ++i) {
    edges[0].push_back(place(i, 0));
    edges[1].push_back(place(0, i));
    edges[2].push_back(triangle ? place(p - i, i) : place(p, i));
    if (!triangle) edges[3].push_back(place(i, p));
  }
  return edges;
}

}  // namespace

std::vector<std::vector<int>> places_of_edges(Shape shape, int order)
{
  if (is_solid(shape)) return places_of_solid_edges(shape, order);
  if (shape != Shape::line) return places_of_surface_edges(shape, order);
  std::vector<int> edge(std::size_t(order) + 1);
  std::iota(edge.begin(), edge.end(), 0);
  return {edge};
}

std::vector<std::vector<int>> edges_of(const ElementBlock& block, int element)
{
  const std::span<const int> nodes = block.element_nodes(element);
  std::vector<std::vector<int>> edges = places_of_edges(block.shape, block.order);
  for (std::vector<int>& edge : edges)
    for (int& node : edge) node = nodes[node];
  return edges;
}

namespace {

using CornerList = std::vector<std::vector<int>>;

/// The corners of the edges of a solid, in the order of its nodes.
const CornerList& solid_edges(Shape shape)
{
  static const CornerList tetrahedron{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  static const CornerList wedge{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                                {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  static const CornerList hexahedron{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                     {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  return shape == Shape::tetrahedron ? tetrahedron : shape == Shape::wedge ? wedge : hexahedron;
}

const CornerList& corners_of_faces(Shape shape)
{
  static const CornerList tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  static const CornerList wedge{{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  static const CornerList hexahedron{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                     {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return shape == Shape::tetrahedron ? tetrahedron : shape == Shape::wedge ? wedge : hexahedron;
}

std::vector<std::array<double, 3>> solid_corners(Shape shape)
{
  if (shape == Shape::tetrahedron) return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (shape == Shape::wedge)
    return {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  return {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
          {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
}

/// The places of the inner nodes of the edge from corner a to corner b.
std::vector<int> inner_places(Shape shape, int order, int a, int b)
{
  const CornerList& edges = solid_edges(shape);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool is_along = edges[i][0] == a && edges[i][1] == b;
    if (!is_along && !(edges[i][0] == b && edges[i][1] == a)) continue;
    std::vector<int> places(std::size_t(order - 1));
    std::iota(places.begin(), places.end(), n_corners(shape) + int(i) * (order - 1));
    if (!is_along) std::ranges::reverse(places);
    return places;
  }
  return {};
}

std::vector<std::vector<int>> places_of_solid_edges(Shape shape, int order)
{
  std::vector<std::vector<int>> edges;
  for (const std::vector<int>& ends : solid_edges(shape)) {
    edges.push_back({ends[0]});
    for (const int place : inner_places(shape, order, ends[0], ends[1]))
      edges.back().push_back(place);
    edges.back().push_back(ends[1]);
  }
  return edges;
}

}  // namespace

int n_corners(Shape shape)
{
  constexpr std::array corners{2, 3, 4, 4, 8, 6};
  return corners[std::size_t(shape)];
}

int n_nodes_of(Shape shape, int order)
{
  switch (shape) {
    case Shape::line:
      return order + 1;
    case Shape::triangle:
      return (order + 1) * (order + 2) / 2;
    case Shape::quadrilateral:
      return (order + 1) * (order + 1);
    default:
      return n_corners(shape) + int(solid_edges(shape).size()) * (order - 1);
  }
}

const char* const solids_are_raised =
    "solids of order 1 got nodes in the middle of their edges: with corners alone they are far too "
    "stiff";

std::vector<int> corner_places(const ElementBlock& block)
{
  const int p = block.order, last = block.nodes_per_element - 1;
  if (block.shape == Shape::line) return {0, p};
  if (block.shape == Shape::triangle) return {0, p, last};
  if (block.shape == Shape::quadrilateral) return {0, p, last, last - p};
  std::vector<int> places(std::size_t(n_corners(block.shape)));
  std::iota(places.begin(), places.end(), 0);
  return places;
}

std::vector<std::array<double, 3>> solid_nodes(Shape shape, int order)
{
  const std::vector<std::array<double, 3>> corners = solid_corners(shape);
  std::vector<std::array<double, 3>> nodes = corners;
  for (const std::vector<int>& ends : solid_edges(shape)) {
    const auto &a = corners[std::size_t(ends[0])], &b = corners[std::size_t(ends[1])];
    for (int i = 1; i < order; ++i) {
      const double share = double(i) / order;
      nodes.push_back({std::lerp(a[0], b[0], share), std::lerp(a[1], b[1], share),
                       std::lerp(a[2], b[2], share)});
    }
  }
  return nodes;
}

std::vector<int> mirrored_places(Shape shape, int order)
{
  const std::vector<std::array<double, 3>> nodes = solid_nodes(shape, order);
  std::vector<int> places;
  constexpr double near = 1e-6;
  for (const auto& [r, s, t] : nodes) {
    const std::array<double, 3> mirrored{s, r, t};
    const auto is_there = [&](const std::array<double, 3>& x) {
      return norm(minus(x, mirrored)) < near;
    };
    places.push_back(static_cast<int>(std::ranges::find_if(nodes, is_there) - nodes.begin()));
  }
  return places;
}

std::vector<std::vector<int>> solid_faces(Shape shape, int order)
{
  std::vector<std::vector<int>> faces = corners_of_faces(shape);
  for (std::vector<int>& face : faces) {
    const std::size_t n = face.size();
    for (std::size_t i = 0; i < n; ++i)
      for (const int place : inner_places(shape, order, face[i], face[(i + 1) % n]))
        face.push_back(place);
  }
  return faces;
}

std::vector<FreeFace> free_faces(const Mesh& mesh)
{
  struct Seen {
    FreeFace face;
    std::array<int, 4> corners;  ///< ascending; -1 for the fourth of a triangle
  };
  std::vector<Seen> all;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const ElementBlock& block = mesh.blocks[b];
    if (!is_solid(block.shape)) continue;
    const std::vector<std::vector<int>> faces = solid_faces(block.shape, block.order);
    const CornerList& corners = corners_of_faces(block.shape);
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::span<const int> nodes = block.element_nodes(e);
      for (std::size_t f = 0; f < faces.size(); ++f) {
        Seen seen{.face = {.block = b, .element = e, .nodes = {}}, .corners = {-1, -1, -1, -1}};
        for (const int place : faces[f]) seen.face.nodes.push_back(nodes[place]);
        std::copy_n(seen.face.nodes.begin(), corners[f].size(), seen.corners.begin());
        std::ranges::sort(seen.corners);
        all.push_back(std::move(seen));
      }
    }
  }
  std::ranges::stable_sort(all, {}, &Seen::corners);
  std::vector<FreeFace> free;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_shared = (i > 0 && all[i - 1].corners == all[i].corners) ||
                           (i + 1 < all.size() && all[i + 1].corners == all[i].corners);
    if (!is_shared) free.push_back(std::move(all[i].face));
  }
  return free;
}

std::vector<LatticeCell> face_cells(int n_nodes, int order, bool with_edge_nodes)
{
  const int n = n_nodes / order;  // corners
  if (!with_edge_nodes || order == 1) return {{0, 1, 2, n - 1}};
  const auto inner = [&](int edge, int i) { return n + edge * (order - 1) + i; };
  std::vector<LatticeCell> cells;
  std::vector<int> middle;
  for (int c = 0; c < n; ++c) {
    const int before = inner((c + n - 1) % n, order - 2), after = inner(c, 0);
    cells.push_back({before, c, after, after});
    for (int i = 0; i < order - 1; ++i) middle.push_back(inner(c, i));
  }
  const std::size_t size = middle.size();
  for (std::size_t i = 1; i + 1 < size; i += 2)
    cells.push_back({middle[0], middle[i], middle[i + 1], middle[std::min(i + 2, size - 1)]});
  return cells;
}

std::vector<std::vector<int>> edges_in(const Mesh& mesh, const Group& group)
{
  std::vector<char> is_member(mesh.positions.size(), 0);
  for (const int node : group.nodes) is_member[node] = 1;
  const auto has = [&](int node) { return is_member[node] != 0; };
  std::set<std::vector<int>> seen;
  std::vector<std::vector<int>> edges;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (std::ranges::none_of(block.element_nodes(e), has)) continue;
      for (std::vector<int>& edge : edges_of(block, e)) {
        if (!std::ranges::all_of(edge, has)) continue;
        std::vector<int> key = edge;
        std::ranges::sort(key);
        if (seen.insert(key).second) edges.push_back(std::move(edge));
      }
    }
  }
  return edges;
}

std::vector<int> corners_first(Shape shape, int order)
{
  if (shape == Shape::line) return line_order(order);
  return shape == Shape::triangle ? triangle_order(order) : quadrilateral_order(order);
}

namespace {

using ParentPoint = std::array<double, 2>;

struct ValueSlope {
  double value, slope;
};

/// Product of linear factors with its derivative.
ValueSlope times(const ValueSlope& a, const ValueSlope& b)
{
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}

/// The Lagrange polynomial of lattice point k of 0..p on [0, 1].
ValueSlope lagrange(int p, int k, double x)
{
  ValueSlope product{1.0, 0.0};
  for (int m = 0; m <= p; ++m)
    if (m != k) product = times(product, {(p * x - m) / (k - m), double(p) / (k - m)});
  return product;
}

/// The factor of a triangle's shape functions that vanishes on the lattice lines below k.
ValueSlope below(int p, int k, double x)
{
  ValueSlope product{1.0, 0.0};
  for (int m = 0; m < k; ++m)
    product = times(product, {(p * x - m) / (m + 1), double(p) / (m + 1)});
  return product;
}

/// Columns and rows of the lattice of an element in its order.
std::vector<std::array<int, 2>> lattice_of(Shape shape, int p)
{
  std::vector<std::array<int, 2>> lattice;
  for (int row = 0; row <= p; ++row)
    for (int column = 0; column <= (shape == Shape::triangle ? p - row : p); ++column)
      lattice.push_back({column, row});
  return lattice;
}

/// d N / d xi and d N / d eta of the shape function of a place in the lattice.
std::array<double, 2> slopes(Shape shape, int p, const std::array<int, 2>& place,
                             const ParentPoint& at)
{
  const auto [k, l] = place;
  const auto [r, s] = at;
  if (shape == Shape::quadrilateral) {
    const ValueSlope a = lagrange(p, k, r), b = lagrange(p, l, s);
    return {a.slope * b.value, a.value * b.slope};
  }
  const ValueSlope a = below(p, k, r), b = below(p, l, s), c = below(p, p - k - l, 1.0 - r - s);
  return {(a.slope * c.value - a.value * c.slope) * b.value,
          (b.slope * c.value - b.value * c.slope) * a.value};
}

ShapeDerivatives derivatives_at(Shape shape, int p, const std::vector<ParentPoint>& points)
{
  const auto lattice = lattice_of(shape, p);
  ShapeDerivatives d{.n_nodes = static_cast<int>(lattice.size()), .first = {}, .second = {}};
  for (const ParentPoint& point : points) {
    for (const auto& place : lattice) {
      const auto [first, second] = slopes(shape, p, place, point);
      d.first.push_back(first);
      d.second.push_back(second);
    }
  }
  return d;
}

/// The roots of the Legendre polynomial of degree n, moved to [0, 1], by Newton's method.
std::vector<double> gauss_abscissas(int n)
{
  std::vector<double> abscissas;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    for (int iteration = 0; iteration < 10; ++iteration) {
      double before = 1.0, value = x;  // P_0 and P_1
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
      }
      x -= value * (x * x - 1.0) / (n * (x * value - before));
    }
    abscissas.push_back(0.5 * (1.0 - x));
  }
  return abscissas;
}

Vector plus_scaled(const Vector& a, double factor, const Vector& b)
{
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// Zero where `a` is.
Vector direction(const Vector& a)
{
  return norm(a) > 0.0 ? unit(a) : a;
}

using LatticePlace = std::array<int, 2>;

/// Steps in the lattice along an edge and from it into the element.
struct LatticeEdge {
  LatticePlace along, inward;
};

/// The edges of an element at a place of its lattice.
class LatticeEdges {
 public:
  LatticeEdges(const ElementBlock& block, int place)
      : p_(block.order), is_triangle_(block.shape == Shape::triangle), at_{place, 0}
  {
    for (int length = p_ + 1; at_[0] >= length; length -= is_triangle_ ? 1 : 0) {
      at_[0] -= length;
      ++at_[1];
    }
  }
  std::vector<LatticeEdge> edges() const
  {
    const auto [i, j] = at_;
    std::vector<LatticeEdge> found;
    if (j == 0) found.push_back({.along = {1, 0}, .inward = {0, 1}});
    if (i == 0) found.push_back({.along = {0, 1}, .inward = {1, 0}});
    if (is_triangle_ && i + j == p_) found.push_back({.along = {-1, 1}, .inward = {-1, 0}});
    if (!is_triangle_ && j == p_) found.push_back({.along = {1, 0}, .inward = {0, -1}});
    if (!is_triangle_ && i == p_) found.push_back({.along = {0, 1}, .inward = {-1, 0}});
    return found;
  }
  /// The place some steps on; -1 outside.
  int step(const LatticePlace& by, int n) const
  {
    const int i = at_[0] + n * by[0], j = at_[1] + n * by[1];
    if (i < 0 || j < 0 || (is_triangle_ ? i + j : std::max(i, j)) > p_) return -1;
    return j * (p_ + 1) - (is_triangle_ ? j * (j - 1) / 2 : 0) + i;
  }

 private:
  int p_;
  bool is_triangle_;
  LatticePlace at_;
};

}  // namespace

ShapeDerivatives node_derivatives(Shape shape, int order)
{
  std::vector<ParentPoint> points;
  for (const auto& [column, row] : lattice_of(shape, order))
    points.push_back({double(column) / order, double(row) / order});
  return derivatives_at(shape, order, points);
}

ShapeDerivatives gauss_derivatives(Shape shape, int order)
{
  std::vector<ParentPoint> points;
  const std::vector<double> abscissas = gauss_abscissas(order + 1);
  for (const double s : abscissas)
    for (const double r : abscissas)
      points.push_back({shape == Shape::triangle ? r * (1.0 - s) : r, s});
  return derivatives_at(shape, order, points);
}

std::array<Vector, 2> tangents(const Mesh& mesh, std::span<const int> nodes,
                               const ShapeDerivatives& derivatives, int point)
{
  std::array<Vector, 2> a{};
  const std::size_t first = std::size_t(point) * nodes.size();
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Vector& x = mesh.positions[std::size_t(nodes[j])];
    a[0] = plus_scaled(a[0], derivatives.first[first + j], x);
    a[1] = plus_scaled(a[1], derivatives.second[first + j], x);
  }
  return a;
}

FaceAtNode face_at_node(const Mesh& mesh, const ElementBlock& block, int element, int place,
                        const ShapeDerivatives& derivatives)
{
  const std::span<const int> nodes = block.element_nodes(element);
  const std::array<Vector, 2> a = tangents(mesh, nodes, derivatives, place);
  const auto step_in_space = [&](const LatticePlace& d) {
    return plus_scaled(plus_scaled({}, d[0], a[0]), d[1], a[1]);
  };
  FaceAtNode face{.normal = direction(cross(a[0], a[1])), .angle = std::numbers::pi, .edges = {}};
  const LatticeEdges lattice(block, place);
  for (const auto& [along, inward] : lattice.edges()) {
    EdgeAtNode edge{.next = -1, .other = -1, .along = {}, .inward = {}};
    for (const int side : {1, -1}) {
      const int at = lattice.step(along, side);
      if (at < 0) continue;
      const int node = nodes[std::size_t(at)];
      edge.other = edge.next;
      if (edge.next >= 0 && edge.next < node) {
        edge.other = node;
        continue;
      }
      edge.next = node;
      edge.along = direction(step_in_space({side * along[0], side * along[1]}));
    }
    const Vector in = step_in_space(inward);
    edge.inward = direction(plus_scaled(in, -dot(in, edge.along), edge.along));
    face.edges.push_back(edge);
  }
  if (face.edges.size() == 2)
    face.angle = std::acos(std::clamp(dot(face.edges[0].along, face.edges[1].along), -1.0, 1.0));
  return face;
}

double fold_angle(const Vector& a, const Vector& b)
{
  return std::acos(std::clamp(-dot(a, b), -1.0, 1.0));
}

std::vector<double> face_functions(std::size_t n_nodes, int order, double r, double s)
{
  const auto p = static_cast<std::size_t>(order), n_corners = n_nodes / p;
  std::vector<double> N(n_nodes, 0.0);
  if (n_corners == 3) {
    const std::array<double, 3> L{1.0 - r - s, r, s};
    for (std::size_t i = 0; i < 3; ++i) {
      N[i] = order == 1 ? L[i] : L[i] * (2.0 * L[i] - 1.0);
      if (order == 2) N[3 + i] = 4.0 * L[i] * L[(i + 1) % 3];
    }
    return N;
  }
  const std::array<double, 4> along{r, s, -r, -s}, across{1.0 - s, 1.0 + r, 1.0 + s, 1.0 - r};
  for (std::size_t edge = 0; edge < 4; ++edge) {
    for (std::size_t k = 0; k <= p; ++k) {
      double of_edge = 0.5 * across[edge];
      const auto at = [&](std::size_t i) { return -1.0 + 2.0 * double(i) / double(p); };
      for (std::size_t i = 0; i <= p; ++i)
        if (i != k) of_edge *= (along[edge] - at(i)) / (at(k) - at(i));
      N[k == 0 ? edge : k == p ? (edge + 1) % 4 : 4 + edge * (p - 1) + k - 1] += of_edge;
    }
    N[edge] -= 0.25 * across[edge] * across[(edge + 3) % 4];
  }
  return N;
}

}  // namespace chladni::mesh
