#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

#include "sound/helmholtz_element.hpp"
#include "sound/outline.hpp"

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

/// Options of a mesh of the air around an outline.
struct AirMeshOptions {
  int order = 4;           ///< order of the elements
  double element_size;     ///< largest element size, m
  double edge_size;        ///< element size at the sharp edges of the body, m
  double growth = 0.6;     ///< increase of the size per distance from the edges
  double inner_radius;     ///< radius of the sphere where the absorbing shell begins, m
  double shell_thickness;  ///< m
  bool half_space;         ///< mesh only z > 0, for fields antisymmetric about z = 0
};

/// Triangles in the meridian plane of an axisymmetric outline.
/// @throws chladni::Error when Gmsh fails or the sphere does not contain the body.
AirMesh mesh_meridian(const Outline& outline, const AirMeshOptions& options);

/// Tetrahedra around an outline.
/// @throws chladni::Error when Gmsh fails or the sphere does not contain the body.
AirMesh mesh_space(const Outline& outline, const AirMeshOptions& options);

/// Finds the element of an air mesh that contains a point, to interpolate nodal fields.
class Locator {
 public:
  explicit Locator(std::shared_ptr<const AirMesh> mesh);

  /// Interpolated values of nodal fields. Below z = 0 of a half space they are those of the mirror
  /// point with opposite sign.
  /// @param x  m
  /// @param p  [n_nodes x n_fields]
  /// @return [n_fields]
  /// @throws chladni::Error when no element contains the point, so that it is inside the body.
  Eigen::RowVectorXcd value(const Eigen::Vector3d& x, const Eigen::MatrixXcd& p) const;

 private:
  std::optional<Eigen::RowVectorXd> reference_place(int element, const Eigen::RowVectorXd& x) const;

  std::shared_ptr<const AirMesh> mesh_;
  Eigen::MatrixXd low_, high_;  ///< [n_elements x dimension] bounding boxes of the elements
};

}  // namespace chladni::sound
