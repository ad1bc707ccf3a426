#pragma once

#include <Eigen/Core>
#include <vector>

#include "sound/reference_cell.hpp"

namespace chladni::sound {

/// Node numbers of the elements, one row each.
using Nodes = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A face of an element.
struct ElementFace {
  int element;  ///< index in the mesh
  int face;     ///< index in reference_faces
};

/// A mesh of the air around a body up to a sphere, with an absorbing shell around it: triangles in
/// the meridian plane (r, z) of an axisymmetric body, or tetrahedra. For fields antisymmetric about
/// z = 0 only z > 0 is meshed.
struct AirMesh {
  LagrangeBasis basis;
  Eigen::MatrixXd positions;      ///< [n_nodes x 2 or 3] m
  Nodes elements;                 ///< [n_elements x n_nodes of the basis]
  std::vector<ElementFace> body;  ///< faces on the surface of the body
  std::vector<int> outer;         ///< nodes on the outer sphere
  std::vector<int> symmetry;      ///< nodes in the plane z = 0 when only z > 0 is meshed
  std::vector<int> axis;          ///< nodes with r = 0 in a meridian plane
  double centre;                  ///< z of the centre of the sphere, m
  double inner_radius;            ///< inner radius of the absorbing shell, m
  double outer_radius;            ///< outer radius of the absorbing shell, m
  double largest_edge;            ///< longest straight edge of an element, m
  bool half_space;                ///< only z > 0 is meshed

  int dimension() const { return basis.dimension(); }
  int n_nodes() const { return static_cast<int>(positions.rows()); }
  int n_elements() const { return static_cast<int>(elements.rows()); }
};

}  // namespace chladni::sound
