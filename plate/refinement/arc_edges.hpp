#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::plate {

/// The arc of a circle on which the nodes of an element edge lie at equal angles: what a polynomial
/// edge of order 2 and more stands for.
class ArcEdge {
 public:
  /// Nothing for a straight edge, one of two nodes, and one whose nodes lie on no circle.
  /// @param nodes  [p + 1 x 3] from end to end, m
  static std::optional<ArcEdge> through(const Eigen::MatrixX3d& nodes);

  /// From the polynomial to the arc, at t in [0, 1] of the edge; m.
  Eigen::RowVector3d correction(double t) const;

 private:
  Eigen::MatrixX3d nodes_;
  Eigen::RowVector3d centre_, first_, across_;  ///< radius vectors to the start, and square to it
  double angle_ = 0.0;                          ///< rad, of the whole edge
};

/// The arcs of an element's edges, and what they move inside of it: each edge's correction falls
/// linearly to nothing at what is opposite to it.
class ArcElement {
 public:
  ArcElement(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element);

  bool is_straight() const { return edges_.empty(); }
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

}  // namespace chladni::plate
