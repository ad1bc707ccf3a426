#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::plate {

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

}  // namespace chladni::plate
