#pragma once

#include <Eigen/Core>
#include <vector>

#include "sound/reference_cell.hpp"

namespace chladni::sound {

using Nodes = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A face of an element, by the element's place and the face's in reference_faces.
struct ElementFace {
  int element;
  int face;
};

/// The air around a body up to a sphere, and an absorbing shell around that: triangles in the
/// meridian plane (r, z) of an axisymmetric body, or tetrahedra. Where the field is antisymmetric
/// to z = 0 only z > 0 is meshed.
struct AirMesh {
  LagrangeBasis basis;
  Eigen::MatrixXd positions;  ///< [n_nodes x 2 or 3] m
  Nodes elements;             ///< [n_elements x n_nodes of the basis]
  std::vector<ElementFace> body;
  std::vector<int> outer;     ///< nodes of the outer sphere
  std::vector<int> symmetry;  ///< nodes in the plane z = 0, when only z > 0 is meshed
  std::vector<int> axis;      ///< nodes with r = 0 of a meridian plane
  double centre;              ///< z of the centre of the sphere, m
  double inner_radius;        ///< where the absorbing shell begins, m
  double outer_radius;        ///< where it ends, m
  double largest_edge;        ///< longest straight edge of an element, m
  bool half_space;            ///< only z > 0 is meshed

  int dimension() const { return basis.dimension(); }
  int n_nodes() const { return static_cast<int>(positions.rows()); }
  int n_elements() const { return static_cast<int>(elements.rows()); }
};

}  // namespace chladni::sound
