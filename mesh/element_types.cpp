#include "mesh/element_types.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <utility>

namespace chladni::mesh {

namespace {

/// Lattice place of column i and row j; the rows of a triangle grow shorter.
class Lattice {
 public:
  explicit Lattice(const ElementBlock& block)
      : p_(block.order), is_triangle_(block.shape == Shape::triangle)
  {}
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
  const Lattice place(block);
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

std::vector<std::vector<int>> edges_of(const ElementBlock& block, int element)
{
  const int p = block.order;
  const std::span<const int> nodes = block.element_nodes(element);
  if (block.shape == Shape::line) return {{nodes.begin(), nodes.end()}};
  const bool triangle = block.shape == Shape::triangle;
  const Lattice place(block);
  std::vector<std::vector<int>> edges(triangle ? 3 : 4);
  for (int i = 0; i <= p; ++i) {
    edges[0].push_back(nodes[place(i, 0)]);
    edges[1].push_back(nodes[place(0, i)]);
    edges[2].push_back(nodes[triangle ? place(p - i, i) : place(p, i)]);
    if (!triangle) edges[3].push_back(nodes[place(i, p)]);
  }
  return edges;
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

}  // namespace chladni::mesh
