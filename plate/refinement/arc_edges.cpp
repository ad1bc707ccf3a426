#include "plate/refinement/arc_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/element_parts.hpp"
#include "plate/elements/interpolation.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index, Eigen::MatrixX3d, Eigen::RowVector3d;

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

}  // namespace

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

}  // namespace chladni::plate
