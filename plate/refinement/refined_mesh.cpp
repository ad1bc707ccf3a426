#include "plate/refinement/refined_mesh.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "mesh/mesh.hpp"
#include "plate/elements/interpolation.hpp"
#include "plate/elements/solid_element.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::MatrixX3d, Eigen::MatrixXd, Eigen::RowVector2d, Eigen::RowVector3d,
    Eigen::VectorXd;
using mesh::ElementBlock, mesh::Mesh, mesh::Shape;

namespace {

/// Lattice points of an element with `n` intervals in each direction, in the order of
/// mesh::ElementBlock.
class Lattice {
 public:
  Lattice(mesh::Shape shape, int n) : shape_(shape), n_(n) {}

  mesh::Shape shape() const { return shape_; }
  int n() const { return n_; }
  int size() const;
  int place(int i, int j) const;
  /// Number of points in row j.
  int n_columns(int j) const { return shape_ == mesh::Shape::triangle ? n_ - j + 1 : n_ + 1; }
  int n_rows() const { return shape_ == mesh::Shape::line ? 1 : n_ + 1; }
  /// The places along each edge. Edges and their points are in the order of mesh::edges_of.
  std::vector<std::vector<int>> edges() const;

 private:
  mesh::Shape shape_;
  int n_;
};

/// The places along the edges of an element, 0 to 1, at which it is cut in two, in the order of
/// mesh::edges_of.
using Cuts = std::array<double, 4>;

constexpr Cuts in_the_middle{0.5, 0.5, 0.5, 0.5};

/// A part of an element: the lattice place of its first corner, and its direction.
struct Part {
  int i, j, sign;
};

/// A point between the four corners of a part of a quadrilateral.
RowVector2d between(const std::array<RowVector2d, 4>& corners, double u, double v)
{
  return (1.0 - u) * ((1.0 - v) * corners[0] + v * corners[2]) +
         u * ((1.0 - v) * corners[1] + v * corners[3]);
}

/// The corners of the 2 x 2 parts of a quadrilateral, xi fastest.
std::array<std::array<RowVector2d, 3>, 3> corners_of_quarters(const Cuts& cuts)
{
  const auto [low, left, right, high] = cuts;
  // Where the lines between opposite cuts meet.
  const double r = (low + (high - low) * left) / (1.0 - (high - low) * (right - left));
  const double s = left + (right - left) * r;
  return {{{RowVector2d(0.0, 0.0), RowVector2d(low, 0.0), RowVector2d(1.0, 0.0)},
           {RowVector2d(0.0, left), RowVector2d(r, s), RowVector2d(1.0, right)},
           {RowVector2d(0.0, 1.0), RowVector2d(high, 1.0), RowVector2d(1.0, 1.0)}}};
}

RowVector2d in_quarters(int i, int j, int q, const Cuts& cuts)
{
  const auto corners = corners_of_quarters(cuts);
  const int column = i > q ? 1 : 0, row = j > q ? 1 : 0;
  const auto& below = corners.at(static_cast<std::size_t>(row));
  const auto& above = corners.at(static_cast<std::size_t>(row) + 1);
  const auto c = static_cast<std::size_t>(column);
  return between({below.at(c), below.at(c + 1), above.at(c), above.at(c + 1)},
                 double(i - column * q) / q, double(j - row * q) / q);
}

/// Of the four triangles between corners and cuts.
RowVector2d in_triangles(int i, int j, int q, const Cuts& cuts)
{
  const RowVector2d corner(0.0, 0.0), first(1.0, 0.0), second(0.0, 1.0);
  const RowVector2d on_r(cuts[0], 0.0), on_s(0.0, cuts[1]), across(1.0 - cuts[2], cuts[2]);
  const auto point = [&](const RowVector2d& from, const RowVector2d& a, const RowVector2d& b, int m,
                         int n) -> RowVector2d {
    return from + double(m) / q * (a - from) + double(n) / q * (b - from);
  };
  if (i + j <= q) return point(corner, on_r, on_s, i, j);
  if (i >= q) return point(on_r, first, across, i - q, j);
  if (j >= q) return point(on_s, across, second, i, j - q);
  return point(across, on_s, on_r, q - i, q - j);
}

RowVector2d parameters_of(const Lattice& lattice, int i, int j, int parts, const Cuts& cuts)
{
  const int q = lattice.n() / 2;
  if (parts == 1 || cuts == in_the_middle)
    return {double(i) / lattice.n(), double(j) / lattice.n()};
  if (lattice.shape() == Shape::triangle) return in_triangles(i, j, q, cuts);
  return in_quarters(i, j, q, cuts);
}

int Lattice::size() const
{
  switch (shape_) {
    case Shape::line:
      return n_ + 1;
    case Shape::triangle:
      return (n_ + 1) * (n_ + 2) / 2;
    default:
      return (n_ + 1) * (n_ + 1);
  }
}

int Lattice::place(int i, int j) const
{
  if (shape_ == Shape::triangle) return j * (n_ + 1) - j * (j - 1) / 2 + i;
  return j * (n_ + 1) + i;
}

std::vector<std::vector<int>> Lattice::edges() const
{
  const bool is_line = shape_ == Shape::line, is_triangle = shape_ == Shape::triangle;
  std::vector<std::vector<int>> edges(is_line ? 1 : is_triangle ? 3 : 4);
  for (int i = 0; i <= n_; ++i) {
    edges[0].push_back(place(i, 0));
    if (is_line) continue;
    edges[1].push_back(place(0, i));
    edges[2].push_back(is_triangle ? place(n_ - i, i) : place(n_, i));
    if (!is_triangle) edges[3].push_back(place(i, n_));
  }
  return edges;
}

/// The parameters r and s of lattice points, in [0, 1] along the first two edges. Each part between
/// the cuts of opposite edges (of the three edges of a triangle) has equidistant points.
/// @param parts  2, or 1 without cuts
std::vector<std::array<double, 2>> lattice_parameters(const Lattice& lattice, int parts,
                                                      const Cuts& cuts)
{
  std::vector<std::array<double, 2>> parameters(static_cast<std::size_t>(lattice.size()));
  for (int j = 0; j < lattice.n_rows(); ++j) {
    for (int i = 0; i < lattice.n_columns(j); ++i) {
      const RowVector2d at = parameters_of(lattice, i, j, parts, cuts);
      parameters[static_cast<std::size_t>(lattice.place(i, j))] = {at[0], at[1]};
    }
  }
  return parameters;
}

/// All parts of an element that is cut into `parts` in each direction.
std::vector<Part> parts_of(Shape shape, int parts)
{
  std::vector<Part> all;
  for (int j = 0; j < (shape == Shape::line ? 1 : parts); ++j) {
    for (int i = 0; i < (shape == Shape::triangle ? parts - j : parts); ++i) {
      all.push_back({.i = i, .j = j, .sign = 1});
      // The triangle between three others is turned by half a turn.
      if (shape == Shape::triangle && i + j + 2 <= parts)
        all.push_back({.i = i + 1, .j = j + 1, .sign = -1});
    }
  }
  return all;
}

/// The values of the shape functions of an element at some parameters.
/// @return [n_points x nodes_per_element]
Eigen::MatrixXd shapes_at(Shape shape, int order,
                          const std::vector<std::array<double, 2>>& parameters)
{
  const Index n = std::ssize(parameters);
  Points points{.xi = VectorXd(n), .eta = VectorXd(n), .weight = {}};
  for (Index k = 0; k < n; ++k) {
    const auto& [r, s] = parameters[static_cast<std::size_t>(k)];
    points.xi[k] = shape == Shape::triangle ? r : 2.0 * r - 1.0;
    points.eta[k] = shape == Shape::triangle ? s : 2.0 * s - 1.0;
  }
  if (shape == Shape::line) return lagrange(VectorXd::LinSpaced(order + 1, -1.0, 1.0), points.xi);
  return lagrange_basis(shape, order, points).N;
}

/// Finds where element edges are cut: in the middle, or nearer to a free edge of the shell if one
/// end of the edge lies on it.
class EdgeCuts {
 public:
  /// @param rows  [n_nodes] m, wanted distance of the cut from a free edge at each node; or empty
  EdgeCuts(const mesh::Mesh& mesh, const std::vector<double>& rows);

  /// The place of the cut, at t in (0, 1) along the edge.
  /// @param edge  its nodes from end to end
  double cut(const std::vector<int>& edge) const;
  /// The cuts of all edges of an element.
  Cuts cuts(const mesh::ElementBlock& block, int element) const;

 private:
  const mesh::Mesh& mesh_;
  const std::vector<double>& rows_;
  std::vector<char> is_free_;  ///< [n_nodes] true at the ends of edges with one element
  std::map<std::vector<int>, int> n_elements_;  ///< of each edge, its nodes ascending
};

std::vector<int> key_of(std::vector<int> edge)
{
  std::ranges::sort(edge);
  return edge;
}

EdgeCuts::EdgeCuts(const mesh::Mesh& mesh, const std::vector<double>& rows)
    : mesh_(mesh), rows_(rows), is_free_(mesh.positions.size(), 0)
{
  if (rows.empty()) return;
  std::vector<int> low_of(mesh.positions.size());  // at the cut edges of a sector, where it goes on
  std::iota(low_of.begin(), low_of.end(), 0);
  for (const auto& [low, high] : mesh.sectors.pairs) low_of[static_cast<std::size_t>(high)] = low;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (!mesh::is_surface(block.shape)) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      for (std::vector<int>& edge : mesh::edges_of(block, e)) {
        for (int& node : edge) node = low_of[static_cast<std::size_t>(node)];
        ++n_elements_[key_of(edge)];
      }
    }
  }
  for (const auto& [edge, n] : n_elements_)
    if (n == 1)
      for (const int node : edge) is_free_[static_cast<std::size_t>(node)] = 1;
  for (const auto& [low, high] : mesh.sectors.pairs)
    is_free_[static_cast<std::size_t>(high)] = is_free_[static_cast<std::size_t>(low)];
}

double EdgeCuts::cut(const std::vector<int>& edge) const
{
  constexpr double middle = 0.5;
  constexpr double near_middle = 0.3;  // a half of the element is about as wide as the row
  if (rows_.empty()) return middle;
  const auto a = static_cast<std::size_t>(edge.front()), b = static_cast<std::size_t>(edge.back());
  if (is_free_[a] == is_free_[b]) return middle;
  const auto& x = mesh_.positions[a];
  const auto& y = mesh_.positions[b];
  const double length = std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
  const double share = rows_[is_free_[a] != 0 ? a : b] / length;
  if (share > near_middle) return middle;
  return is_free_[a] != 0 ? share : 1.0 - share;
}

Cuts EdgeCuts::cuts(const mesh::ElementBlock& block, int element) const
{
  Cuts cuts = in_the_middle;
  if (rows_.empty() || !mesh::is_surface(block.shape)) return cuts;
  const std::vector<std::vector<int>> edges = mesh::edges_of(block, element);
  for (std::size_t k = 0; k < edges.size(); ++k) cuts.at(k) = cut(edges[k]);
  return cuts;
}

/// The circular arc on which the nodes of an element edge lie at equal angles, and which the
/// polynomial edge of order 2 or higher approximates.
class ArcEdge {
 public:
  /// The arc through the nodes of an edge; absent for a straight edge, an edge with two nodes, and
  /// one whose nodes lie on no circle.
  /// @param nodes  [p + 1 x 3] from end to end, m
  static std::optional<ArcEdge> through(const Eigen::MatrixX3d& nodes);

  /// The vector from the polynomial to the arc at t in [0, 1] of the edge, m.
  Eigen::RowVector3d correction(double t) const;

 private:
  Eigen::MatrixX3d nodes_;
  /// centre; radius vector to the start; the one square to it
  Eigen::RowVector3d centre_, first_, across_;
  double angle_ = 0.0;  ///< rad, of the whole edge
};

/// The arcs of the edges of an element, and the displacement of its inside by them: the correction
/// of each edge decreases linearly to zero at the opposite side or corner.
class ArcElement {
 public:
  ArcElement(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element);

  bool is_straight() const { return edges_.empty(); }
  /// The displacement of a point of the element, m.
  /// @param r, s  in [0, 1] along the first two edges of the element, as mesh::ElementBlock
  Eigen::RowVector3d correction(double r, double s) const;

 private:
  struct Edge {
    int number;  ///< as mesh::edges_of
    ArcEdge arc;
  };
  mesh::Shape shape_;
  std::vector<Edge> edges_;
};

/// The centre of the circle through three points; nothing where they are in line.
std::optional<RowVector3d> centre_of(const RowVector3d& a, const RowVector3d& b,
                                     const RowVector3d& c)
{
  constexpr double least_bow = 1e-6;  // of the chord
  const RowVector3d u = b - a, v = c - a;
  const RowVector3d normal = u.cross(v);
  const double square = normal.squaredNorm();
  if (std::sqrt(square) < least_bow * v.squaredNorm()) return std::nullopt;
  return a +
         (u.squaredNorm() * v.cross(normal) - v.squaredNorm() * u.cross(normal)) / (2.0 * square);
}

/// An edge's parameter, and the distance from it, 1 at what is opposite.
struct EdgePlace {
  double t, distance;
};

EdgePlace place_at(mesh::Shape shape, int edge, double r, double s)
{
  if (shape == mesh::Shape::quadrilateral) {
    const double t = edge == 0 || edge == 3 ? r : s;
    const double distance = edge == 0 ? s : edge == 1 ? r : edge == 2 ? 1.0 - r : 1.0 - s;
    return {.t = t, .distance = distance};
  }
  // Barycentric coordinates of the ends of the edge.
  const double l = 1.0 - r - s;
  const double from = edge == 0 || edge == 1 ? l : r, to = edge == 0 ? r : s;
  const double sum = from + to;
  return {.t = sum > 0.0 ? to / sum : 0.0, .distance = 1.0 - sum};
}

std::optional<ArcEdge> ArcEdge::through(const MatrixX3d& nodes)
{
  constexpr double same = 1e-6;  // of the length of the edge
  const Index n = nodes.rows();
  if (n < 3) return std::nullopt;
  const RowVector3d start = nodes.row(0), end = nodes.row(n - 1);
  const auto centre = centre_of(start, nodes.row(n / 2), end);
  if (!centre) return std::nullopt;
  ArcEdge arc;
  arc.nodes_ = nodes;
  arc.centre_ = *centre;
  arc.first_ = start - *centre;
  const RowVector3d axis = arc.first_.cross(RowVector3d(nodes.row(n / 2) - *centre)).normalized();
  arc.across_ = axis.cross(arc.first_);
  const RowVector3d last = end - *centre;
  arc.angle_ = std::atan2(last.dot(arc.across_), last.dot(arc.first_));
  if (arc.angle_ <= 0.0) return std::nullopt;  // half a turn and more
  const double tolerance = same * (end - start).norm();
  for (Index i = 1; i < n - 1; ++i)
    if (arc.correction(double(i) / double(n - 1)).norm() > tolerance) return std::nullopt;
  return arc;
}

RowVector3d ArcEdge::correction(double t) const
{
  const Eigen::VectorXd places = Eigen::VectorXd::LinSpaced(nodes_.rows(), 0.0, 1.0);
  const RowVector3d on_polynomial = lagrange(places, Eigen::VectorXd::Constant(1, t)) * nodes_;
  const double angle = t * angle_;
  return centre_ + std::cos(angle) * first_ + std::sin(angle) * across_ - on_polynomial;
}

ArcElement::ArcElement(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element)
    : shape_(block.shape)
{
  const std::vector<std::vector<int>> edges = mesh::edges_of(block, element);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    MatrixX3d nodes(std::ssize(edges[k]), 3);
    for (Index i = 0; i < nodes.rows(); ++i) {
      const auto& x =
          mesh.positions[static_cast<std::size_t>(edges[k][static_cast<std::size_t>(i)])];
      nodes.row(i) << x[0], x[1], x[2];
    }
    if (auto arc = ArcEdge::through(nodes))
      edges_.push_back({.number = static_cast<int>(k), .arc = std::move(*arc)});
  }
}

RowVector3d ArcElement::correction(double r, double s) const
{
  RowVector3d moved = RowVector3d::Zero();
  for (const Edge& edge : edges_) {
    const EdgePlace place = place_at(shape_, edge.number, r, s);
    if (place.distance < 1.0) moved += (1.0 - place.distance) * edge.arc.correction(place.t);
  }
  return moved;
}

using Parameters = std::vector<std::array<double, 2>>;

/// A part of a solid by the parent coordinates of its corners.
using SolidPart = std::vector<Eigen::RowVector3d>;

/// The eight parts of a solid that is halved in each direction: of a tetrahedron those at its
/// corners, and four around the diagonal of the rest.
std::vector<SolidPart> solid_parts(Shape shape, int parts)
{
  const std::vector<std::array<double, 3>> nodes = mesh::solid_nodes(shape, 1);
  const auto n = static_cast<std::size_t>(mesh::n_corners(shape));
  const auto at = [&](std::size_t place) { return Eigen::RowVector3d(nodes[place].data()); };
  std::vector<SolidPart> all;
  SolidPart whole;
  for (std::size_t i = 0; i < n; ++i) whole.push_back(at(i));
  if (parts == 1) return {whole};
  const auto scaled = [&](const Eigen::RowVector3d& towards) {
    SolidPart part;
    for (const RowVector3d& corner : whole) part.push_back(0.5 * (corner + towards));
    return part;
  };
  for (std::size_t i = 0; i < n; ++i) all.push_back(scaled(whole[i]));
  if (shape == Shape::wedge) {
    for (const std::size_t bottom : {0, 3}) {  // the triangle between three others, by half a turn
      const RowVector3d sum = whole[bottom] + whole[bottom + 1] + whole[bottom + 2];
      SolidPart part;
      for (const RowVector3d& corner : whole) {
        RowVector3d turned = 0.5 * (sum - corner);
        turned[2] = 0.5 * (corner[2] + whole[bottom][2]);
        part.push_back(turned);
      }
      all.push_back(part);
    }
  }
  if (shape != Shape::tetrahedron) return all;
  const auto middle = [&](std::size_t i, std::size_t j) -> RowVector3d {
    return 0.5 * (whole[i] + whole[j]);
  };
  const RowVector3d a = middle(0, 2), b = middle(1, 3);
  const std::array<RowVector3d, 4> around{middle(0, 1), middle(1, 2), middle(2, 3), middle(0, 3)};
  for (std::size_t k = 0; k < 4; ++k) {
    SolidPart part{a, b, around[k], around[(k + 1) % 4]};
    const RowVector3d first = part[1] - part[0], second = part[2] - part[0];
    if (first.cross(second).dot(part[3] - part[0]) < 0.0) std::swap(part[2], part[3]);
    all.push_back(part);
  }
  return all;
}

/// The parts of a solid with their nodes.
struct SolidPattern {
  Eigen::MatrixX3d r;                   ///< [n x 3] parent coordinates of all nodes, each once
  std::vector<std::vector<int>> parts;  ///< their rows
  MatrixXd shapes;                      ///< [n x nodes of the original]
  MatrixXd corners;                     ///< [n x corners] functions of the corners alone
  std::vector<int> same;  ///< [n] the node of the original that stands there; -1: none

  SolidPattern(Shape shape, int order, const Refinement& how);
};

SolidPattern::SolidPattern(Shape shape, int order, const Refinement& how)
{
  constexpr double near = 1e-9;
  const auto place_among = [&](const std::vector<RowVector3d>& points, const RowVector3d& x) {
    const auto is_there = [&](const RowVector3d& other) { return (other - x).norm() < near; };
    return static_cast<int>(std::ranges::find_if(points, is_there) - points.begin());
  };
  std::vector<RowVector3d> points;
  const std::vector<std::array<double, 3>> nodes = mesh::solid_nodes(shape, how.order);
  MatrixX3d own(std::ssize(nodes), 3);
  for (Index i = 0; i < own.rows(); ++i)
    own.row(i) = RowVector3d(nodes[static_cast<std::size_t>(i)].data());
  const MatrixXd linear = solid_shapes(shape, 1, own);
  for (const SolidPart& part : solid_parts(shape, how.parts)) {
    parts.emplace_back();
    for (Index i = 0; i < linear.rows(); ++i) {
      RowVector3d x = RowVector3d::Zero();
      for (std::size_t c = 0; c < part.size(); ++c) x += linear(i, Index(c)) * part[c];
      parts.back().push_back(place_among(points, x));
      if (parts.back().back() == std::ssize(points)) points.push_back(x);
    }
  }
  r.resize(std::ssize(points), 3);
  for (Index i = 0; i < r.rows(); ++i) r.row(i) = points[static_cast<std::size_t>(i)];
  shapes = solid_shapes(shape, order, r);
  corners = solid_shapes(shape, 1, r);
  std::vector<RowVector3d> old;
  for (const std::array<double, 3>& x : mesh::solid_nodes(shape, order)) old.emplace_back(x.data());
  for (const RowVector3d& x : points) {
    const int node = place_among(old, x);
    same.push_back(node < std::ssize(old) ? node : -1);
  }
}

constexpr int highest_order(Shape shape)
{
  if (mesh::is_solid(shape)) return shape == Shape::hexahedron ? 3 : 2;
  return shape == Shape::triangle ? 3 : 4;
}

/// An element of the original at work.
struct Work {
  int block, element;
  std::span<const int> old;  ///< its nodes
  const Lattice& coarse;
  const Lattice& fine;
  const Parameters& parameters;  ///< of the fine lattice
  const MatrixXd& shapes;        ///< there
  bool is_uniform;               ///< nodes of the coarse lattice may be places of the fine one
  ArcElement arcs;
};

/// Builds the refined mesh block by block.
class Refiner {
 public:
  Refiner(const Mesh& mesh, const Refinement& refinement)
      : old_(mesh), how_(refinement), cuts_(mesh, how_.edge_rows)
  {
    for (const std::int64_t number : mesh.node_numbers)
      last_number_ = std::max(last_number_, number);
    same_.assign(mesh.positions.size(), -1);
    for (const mesh::Group& group : mesh.groups) {
      std::vector<char> has(mesh.positions.size(), 0);
      for (const int node : group.nodes) has[static_cast<std::size_t>(node)] = 1;
      members_.push_back(std::move(has));
    }
    joined_.resize(mesh.groups.size());
  }

  RefinedMesh result() &&
  {
    find_faces();
    for (std::size_t b = 0; b < old_.blocks.size(); ++b)
      if (mesh::is_solid(old_.blocks[b].shape))
        add_solids(static_cast<int>(b));
      else
        add_block(static_cast<int>(b));
    keep_free_nodes();
    for (std::size_t g = 0; g < old_.groups.size(); ++g) add_group(g);
    keep_face_nodes();
    return std::move(new_);
  }

 private:
  void add_solids(int b)
  {
    const ElementBlock& old = old_.blocks[static_cast<std::size_t>(b)];
    const SolidPattern pattern(old.shape, old.order, how_);
    ElementBlock block{.shape = old.shape,
                       .order = how_.order,
                       .nodes_per_element = mesh::n_nodes_of(old.shape, how_.order),
                       .numbers = {},
                       .nodes = {},
                       .group = {}};
    for (int e = 0; e < old.n_elements(); ++e) {
      std::vector<int> nodes;
      for (Index i = 0; i < pattern.r.rows(); ++i) nodes.push_back(solid_node(pattern, b, e, i));
      for (const std::vector<int>& part : pattern.parts) {
        for (const int place : part) block.nodes.push_back(nodes[static_cast<std::size_t>(place)]);
        block.numbers.push_back(how_.parts == 1 ? old.numbers[static_cast<std::size_t>(e)]
                                                : ++last_element_);
        block.group.push_back(old.group[static_cast<std::size_t>(e)]);
      }
    }
    new_.mesh.blocks.push_back(std::move(block));
  }

  /// A place is known by the shares that the corners of its element have in it, which elements with
  /// a common edge or face agree on.
  int solid_node(const SolidPattern& pattern, int b, int e, Index place)
  {
    constexpr double unit = 1e-6;
    const ElementBlock& block = old_.blocks[static_cast<std::size_t>(b)];
    const std::span<const int> old = block.element_nodes(e);
    std::vector<std::array<int, 2>> key;
    for (Index c = 0; c < pattern.corners.cols(); ++c) {
      const auto share = static_cast<int>(std::lround(pattern.corners(place, c) / unit));
      if (share != 0) key.push_back({old[static_cast<std::size_t>(c)], share});
    }
    std::ranges::sort(key);
    const auto [known, is_new] = solid_places_.try_emplace(key, -1);
    if (!is_new) return known->second;
    const Eigen::RowVectorXd N = pattern.shapes.row(place);
    const int same = pattern.same[static_cast<std::size_t>(place)];
    if (same >= 0) {
      const int node = same_node(old[static_cast<std::size_t>(same)], {b, e, N});
      return known->second = node;
    }
    std::array<double, 3> x{};
    for (std::size_t i = 0; i < old.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        x[c] += N[static_cast<Index>(i)] * old_.positions[static_cast<std::size_t>(old[i])][c];
    new_.mesh.node_numbers.push_back(++last_number_);
    new_.mesh.positions.push_back(x);
    new_.places.push_back({b, e, N});
    known->second = new_.mesh.n_nodes() - 1;
    join_solids(known->second, block, e, key);
    return known->second;
  }

  /// A new node of a solid joins the groups that have the edge, the face or the element in which
  /// it is.
  void join_solids(int node, const ElementBlock& block, int e,
                   const std::vector<std::array<int, 2>>& corners)
  {
    const std::span<const int> nodes = block.element_nodes(e);
    const std::vector<int> edge = piece_of(mesh::places_of_edges(block.shape, block.order), nodes,
                                           corners, mesh::n_corners(block.shape));
    const std::vector<int> face = piece_of(mesh::solid_faces(block.shape, block.order), nodes,
                                           corners, mesh::n_corners(block.shape));
    const std::vector<int>& piece = !edge.empty() ? edge : face;
    for (std::size_t g = 0; g < members_.size(); ++g) {
      const auto is_member = [&](int one) {
        return members_[g][static_cast<std::size_t>(one)] != 0;
      };
      const int dimension = old_.groups[g].dimension;
      const bool has = dimension == 3   ? std::ranges::all_of(nodes, is_member)
                       : dimension == 1 ? !edge.empty() && std::ranges::all_of(edge, is_member)
                                        : !piece.empty() && faces_[g].contains(piece);
      if (has) joined_[g].push_back(node);
    }
  }

  /// The nodes of the edge or face of a solid in which these corners are all, ascending; none where
  /// there is no such.
  static std::vector<int> piece_of(const std::vector<std::vector<int>>& pieces,
                                   std::span<const int> nodes,
                                   const std::vector<std::array<int, 2>>& corners, int n_corners)
  {
    for (const std::vector<int>& piece : pieces) {
      std::vector<int> found;
      std::size_t n_found = 0;
      for (const int place : piece) {
        found.push_back(nodes[static_cast<std::size_t>(place)]);
        if (place < n_corners && std::ranges::find(corners, found.back(), [](const auto& one) {
                                   return one[0];
                                 }) != corners.end())
          ++n_found;
      }
      if (n_found < corners.size()) continue;
      std::ranges::sort(found);
      return found;
    }
    return {};
  }

  /// The free faces of solids with all their nodes in a group, and the edges of these.
  void find_faces()
  {
    faces_.resize(old_.groups.size());
    for (const mesh::FreeFace& face : mesh::free_faces(old_)) {
      const ElementBlock& block = old_.blocks[face.block];
      const std::span<const int> nodes = block.element_nodes(face.element);
      for (std::size_t g = 0; g < members_.size(); ++g) {
        const auto is_member = [&](int one) {
          return members_[g][static_cast<std::size_t>(one)] != 0;
        };
        if (!std::ranges::all_of(face.nodes, is_member)) continue;
        faces_[g].insert(key_of(face.nodes));
        for (const std::vector<int>& places : mesh::places_of_edges(block.shape, block.order)) {
          std::vector<int> edge;
          for (const int place : places) edge.push_back(nodes[static_cast<std::size_t>(place)]);
          const auto is_of_face = [&](int one) {
            return std::ranges::find(face.nodes, one) != face.nodes.end();
          };
          if (std::ranges::all_of(edge, is_of_face)) faces_[g].insert(key_of(edge));
        }
      }
    }
  }

  void add_block(int b)
  {
    const ElementBlock& old = old_.blocks[static_cast<std::size_t>(b)];
    const Lattice coarse(old.shape, old.order), fine(old.shape, how_.parts * how_.order);
    const Parameters halves = lattice_parameters(fine, how_.parts, in_the_middle);
    const MatrixXd shapes_of_halves = shapes_at(old.shape, old.order, halves);
    const std::vector<Part> parts = parts_of(old.shape, how_.parts);
    ElementBlock block{.shape = old.shape,
                       .order = how_.order,
                       .nodes_per_element = Lattice(old.shape, how_.order).size(),
                       .numbers = {},
                       .nodes = {},
                       .group = {}};
    for (int e = 0; e < old.n_elements(); ++e) {
      const Cuts cuts = cuts_.cuts(old, e);
      const bool is_uniform = cuts == in_the_middle;
      const Parameters own = is_uniform ? halves : lattice_parameters(fine, how_.parts, cuts);
      const MatrixXd shapes = is_uniform ? shapes_of_halves : shapes_at(old.shape, old.order, own);
      const std::vector<int> nodes = lattice_nodes({.block = b,
                                                    .element = e,
                                                    .old = old.element_nodes(e),
                                                    .coarse = coarse,
                                                    .fine = fine,
                                                    .parameters = own,
                                                    .shapes = shapes,
                                                    .is_uniform = is_uniform,
                                                    .arcs = ArcElement(old_, old, e)});
      for (const Part& part : parts) {
        add_part(block, nodes, fine, part);
        block.numbers.push_back(how_.parts == 1 ? old.numbers[static_cast<std::size_t>(e)]
                                                : ++last_element_);
        block.group.push_back(old.group[static_cast<std::size_t>(e)]);
      }
    }
    new_.mesh.blocks.push_back(std::move(block));
  }

  void add_part(ElementBlock& block, const std::vector<int>& nodes, const Lattice& fine,
                const Part& part) const
  {
    const Lattice own(block.shape, how_.order);
    for (int j = 0; j < own.n_rows(); ++j) {
      for (int i = 0; i < own.n_columns(j); ++i) {
        const int column = how_.order * part.i + part.sign * i;
        const int row = how_.order * part.j + part.sign * j;
        block.nodes.push_back(nodes[static_cast<std::size_t>(fine.place(column, row))]);
      }
    }
  }

  /// The new nodes of one element, at all places of the fine lattice: those of its edges, which
  /// neighbours may have made already, then those inside.
  std::vector<int> lattice_nodes(const Work& work)
  {
    const ElementBlock& block = old_.blocks[static_cast<std::size_t>(work.block)];
    std::vector<int> nodes(static_cast<std::size_t>(work.fine.size()), -1);
    const std::vector<std::vector<int>> old_edges = mesh::edges_of(block, work.element);
    const std::vector<std::vector<int>> fine_edges = work.fine.edges();
    for (std::size_t k = 0; k < old_edges.size(); ++k) {
      const std::vector<int>& made = edge_nodes(work, old_edges[k], fine_edges[k]);
      const bool is_turned = old_edges[k].front() > old_edges[k].back();
      for (std::size_t i = 0; i < made.size(); ++i) {
        nodes[static_cast<std::size_t>(fine_edges[k][is_turned ? made.size() - 1 - i : i])] =
            made[i];
      }
    }
    std::vector<int> inner;
    const int p = work.coarse.n(), n = work.fine.n();
    for (int j = 0; j < work.fine.n_rows(); ++j) {
      for (int i = 0; i < work.fine.n_columns(j); ++i) {
        int& node = nodes[static_cast<std::size_t>(work.fine.place(i, j))];
        if (node >= 0) continue;
        const bool is_kept = work.is_uniform && i * p % n == 0 && j * p % n == 0;
        node =
            is_kept
                ? node_of(
                      work,
                      work.old[static_cast<std::size_t>(work.coarse.place(i * p / n, j * p / n))],
                      work.fine.place(i, j))
                : add_node(work, work.fine.place(i, j));
        if (!is_kept) inner.push_back(node);
      }
    }
    join(inner, work.old, 2);
    return nodes;
  }

  /// An edge is known by its nodes; the first element that comes makes those that it lacks.
  /// @return from the end with the lower number
  const std::vector<int>& edge_nodes(const Work& work, std::vector<int> old,
                                     std::vector<int> places)
  {
    if (old.front() > old.back()) {
      std::ranges::reverse(old);
      std::ranges::reverse(places);
    }
    const auto [edge, is_new] = edges_.try_emplace(old);
    if (!is_new) return edge->second;
    const bool is_halved = how_.parts == 1 || cuts_.cut(old) == in_the_middle[0];
    const auto n = static_cast<int>(places.size()) - 1, p = static_cast<int>(old.size()) - 1;
    std::vector<int> added;
    for (int i = 0; i <= n; ++i) {
      const int place = places[static_cast<std::size_t>(i)];
      if (i == 0 || i == n || (is_halved && i * p % n == 0)) {
        edge->second.push_back(node_of(work, old[static_cast<std::size_t>(i * p / n)], place));
      } else {
        added.push_back(add_node(work, place));
        edge->second.push_back(added.back());
      }
    }
    join(added, old, 1);
    return edge->second;
  }

  /// The new name of a node that stays.
  int node_of(const Work& work, int old, int place)
  {
    return same_node(old, {work.block, work.element, work.shapes.row(place)});
  }

  int same_node(int old, RefinedMesh::Place place)
  {
    int& node = same_[static_cast<std::size_t>(old)];
    if (node >= 0) return node;
    node = new_.mesh.n_nodes();
    new_.mesh.node_numbers.push_back(old_.node_numbers[static_cast<std::size_t>(old)]);
    new_.mesh.positions.push_back(old_.positions[static_cast<std::size_t>(old)]);
    new_.places.push_back(std::move(place));
    return node;
  }

  /// Those whose nodes all stay.
  void keep_face_nodes()
  {
    for (mesh::FaceNode on_face : old_.face_nodes) {
      on_face.node = same_[static_cast<std::size_t>(on_face.node)];
      for (int& node : on_face.nodes) node = same_[static_cast<std::size_t>(node)];
      if (std::ranges::find(on_face.nodes, -1) == on_face.nodes.end())
        new_.mesh.face_nodes.push_back(std::move(on_face));
    }
  }

  /// Nodes of no element, which follow others, stay; nothing is interpolated there.
  void keep_free_nodes()
  {
    std::vector<char> is_free(old_.positions.size(), 1);
    for (const ElementBlock& block : old_.blocks)
      for (const int node : block.nodes) is_free[static_cast<std::size_t>(node)] = 0;
    for (std::size_t node = 0; node < is_free.size(); ++node) {
      if (is_free[node] == 0) continue;
      same_[node] = new_.mesh.n_nodes();
      new_.mesh.node_numbers.push_back(old_.node_numbers[node]);
      new_.mesh.positions.push_back(old_.positions[node]);
      const Index n = old_.blocks.front().nodes_per_element;
      new_.places.push_back({0, 0, Eigen::RowVectorXd::Zero(n)});
    }
  }

  int add_node(const Work& work, int place)
  {
    const auto [r, s] = work.parameters[static_cast<std::size_t>(place)];
    const Eigen::RowVector3d moved = work.arcs.correction(r, s);
    std::array<double, 3> x{moved[0], moved[1], moved[2]};
    for (std::size_t i = 0; i < work.old.size(); ++i) {
      const auto& node = old_.positions[static_cast<std::size_t>(work.old[i])];
      for (std::size_t c = 0; c < 3; ++c)
        x[c] += work.shapes(place, static_cast<Index>(i)) * node[c];
    }
    new_.mesh.node_numbers.push_back(++last_number_);
    new_.mesh.positions.push_back(x);
    new_.places.push_back({work.block, work.element, work.shapes.row(place)});
    return new_.mesh.n_nodes() - 1;
  }

  /// New nodes between old ones join the groups of at least this dimension that have all of these.
  void join(const std::vector<int>& added, std::span<const int> between, int dimension)
  {
    if (added.empty()) return;
    for (std::size_t g = 0; g < members_.size(); ++g) {
      if (old_.groups[g].dimension < dimension) continue;
      const auto is_member = [&](int node) {
        return members_[g][static_cast<std::size_t>(node)] != 0;
      };
      if (std::ranges::all_of(between, is_member))
        joined_[g].insert(joined_[g].end(), added.begin(), added.end());
    }
  }

  /// Rings keep their order by angle; other groups ascend.
  void add_group(std::size_t g)
  {
    const mesh::Group& old = old_.groups[g];
    mesh::Group group{.name = old.name, .dimension = old.dimension, .nodes = {}};
    for (const int node : old.nodes)
      if (const int kept = same_[static_cast<std::size_t>(node)]; kept >= 0)
        group.nodes.push_back(kept);
    group.nodes.insert(group.nodes.end(), joined_[g].begin(), joined_[g].end());
    if (old.dimension > 0) std::ranges::sort(group.nodes);
    new_.mesh.groups.push_back(std::move(group));
  }

  const Mesh& old_;
  Refinement how_;
  EdgeCuts cuts_;
  RefinedMesh new_;
  std::int64_t last_number_ = 0, last_element_ = 0;
  std::vector<int> same_;                   ///< [old nodes] new ones, -1 where there is none
  std::vector<std::vector<char>> members_;  ///< [groups][old nodes]
  std::vector<std::vector<int>> joined_;    ///< [groups] new nodes
  std::map<std::vector<int>, std::vector<int>> edges_;  ///< old nodes -> new, from the lower end
  std::vector<std::set<std::vector<int>>> faces_;  ///< [groups] nodes of faces and edges, ascending
  std::map<std::vector<std::array<int, 2>>, int> solid_places_;  ///< old corners with shares -> new
};

}  // namespace

RefinedMesh refined(const Mesh& mesh, const Refinement& refinement)
{
  if (!mesh.equations.empty()) {
    throw Error(
        fmt::format("{}: equations and ties hold at the nodes of this mesh alone, so that a finer "
                    "one, by which "
                    "errors are estimated, has none; take accuracy and mesh_errors out",
                    mesh.equations.front().place));
  }
  return Refiner(mesh, refinement).result();
}

bool has_wide_edges(const Mesh& mesh, const std::vector<double>& rows)
{
  const EdgeCuts cuts(mesh, rows);
  return std::ranges::any_of(mesh.blocks, [&](const ElementBlock& block) {
    for (int e = 0; e < block.n_elements(); ++e)
      if (cuts.cuts(block, e) != in_the_middle) return true;
    return false;
  });
}

bool keeps_points(const Mesh& mesh, const Mesh& refined)
{
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (mesh.groups[g].dimension == 0 &&
        refined.groups[g].nodes.size() < mesh.groups[g].nodes.size())
      return false;
  }
  return true;
}

bool can_rise(const Mesh& mesh)
{
  const int order = mesh.blocks.front().order;
  const bool exists = std::ranges::all_of(mesh.blocks, [&](const ElementBlock& block) {
    return block.order == order && order < highest_order(block.shape);
  });
  return exists && mesh.face_nodes.empty() &&
         keeps_points(mesh, refined(mesh, {.parts = 1, .order = order + 1}).mesh);
}

MatrixXd interpolated(const Mesh& mesh, const RefinedMesh& refined, const MatrixXd& motions)
{
  MatrixXd fine = MatrixXd::Zero(6 * std::ssize(refined.places), motions.cols());
  for (Index n = 0; n < std::ssize(refined.places); ++n) {
    const RefinedMesh::Place& place = refined.places[static_cast<std::size_t>(n)];
    const std::span<const int> nodes =
        mesh.blocks[static_cast<std::size_t>(place.block)].element_nodes(place.element);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      fine.middleRows<6>(6 * n) +=
          place.shapes[static_cast<Index>(i)] * motions.middleRows<6>(6 * Index(nodes[i]));
    }
  }
  for (const mesh::FaceNode& on_face : refined.mesh.face_nodes)
    for (std::size_t i = 0; i < on_face.nodes.size(); ++i) {
      fine.middleRows<6>(6 * Index(on_face.node)) +=
          on_face.weights[i] * fine.middleRows<6>(6 * Index(on_face.nodes[i]));
    }
  return fine;
}

}  // namespace chladni::plate
