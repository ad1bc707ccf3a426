#pragma once

#include <Eigen/Core>

#include <array>

#include "mesh/mesh.hpp"
#include "plate/elements/interpolation.hpp"
#include "plate/elements/mass_points.hpp"
#include "plate/elements/shell_element.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// An element of a solid at its integration points.
struct SolidFrame {
  Eigen::VectorXd dV;  ///< [n_points] m^3, weights times det J
  Eigen::MatrixXd N;   ///< [n_points x n_nodes]
  NodeVectors x;       ///< [n_points x 3] m
  /// x, y, z: [n_points x n_nodes] derivatives of the shape functions, 1/m; of hexahedra of order 1
  /// also of their three incompatible modes, behind the nodes.
  std::array<Eigen::MatrixXd, 3> gradient;
  Eigen::MatrixXd incompatible;  ///< [n_points x 3] values of these modes; else no columns
};

/// The shape functions and their slopes at the integration points: of hexahedra of order p the
/// serendipity space of superlinear degree p and Gauss p + 1 cubed, of tetrahedra of order 2 all
/// polynomials of degree 2 and 14 points (exact to degree 5), of wedges of order 2 the space P2 x
/// P1
/// + P1 x t^2 and 6 x 3 points.
/// @param nodes  [n x 3] m, in the order of mesh::solid_nodes
/// @note   dV is not positive at a point where the element is turned inside out.
/// Source: Arnold and Awanou, Found. Comput. Math. 11 (2011) 337 (serendipity); Walkington,
/// Quadrature on simplices of arbitrary dimension (2000); Dunavant, Int. J. Numer. Methods Eng. 21
/// (1985) 1129.
SolidFrame solid_frame(mesh::Shape shape, int order, const NodeVectors& nodes);

/// The shape functions of an element at some points of its parent coordinates.
/// @param r  [n x 3] as mesh::solid_nodes
/// @return [n x n_nodes]
Eigen::MatrixXd solid_shapes(mesh::Shape shape, int order, const Eigen::MatrixX3d& r);

/// K_e = int B^T C B dV and M_e = int rho N^T N dV of an isotropic solid, with six DOFs a node like
/// all elements; the rows of rotations are zero. Hexahedra of order 1 have nine incompatible modes,
/// eliminated in the element, which pass the patch test by the Jacobian of the centre. They move as
/// K has it and their mass moves with them: the middle of a bent element stands off its corners.
/// Source: Taylor, Beresford and Wilson, Int. J. Numer. Methods Eng. 10 (1976) 1211 (incompatible).
ElementMatrices solid_matrices(const SolidFrame& frame, const Material& material);

/// The integration points of M_e.
MassPoints solid_mass_points(const SolidFrame& frame, const Material& material);

/// K_sigma by the stresses sigma of the static displacements u_e,
///   v^T K_sigma v = int sigma_ab v_,a . v_,b dV.
/// The stresses of hexahedra of order 1 are with their incompatible modes, v is without.
/// @param u_e  [6 n_nodes] m, with rotations that have no effect
/// @return [6 n_nodes squared] symmetric, N/m
/// Source: Zienkiewicz and Taylor, The Finite Element Method 2 (2000), initial stress matrix.
Eigen::MatrixXd solid_geometric_stiffness(const SolidFrame& frame, const Material& material,
                                          const Eigen::VectorXd& u_e);

/// The stresses of a solid where they are most accurate, as linear forms in the DOFs of its nodes.
struct SolidStresses {
  NodeVectors x;  ///< [n_points x 3] m
  Eigen::MatrixXd
      S;  ///< [6 n_points x 6 n_nodes] xx, yy, zz, xy, yz, xz of each point in turn, Pa/m
};

/// At Gauss p cubed of hexahedra of order p, 4 points of tetrahedra and 3 x 2 of wedges.
/// Source: Barlow, Int. J. Numer. Methods Eng. 10 (1976) 243 (where stresses are accurate).
SolidStresses solid_stresses(mesh::Shape shape, int order, const NodeVectors& nodes,
                             const Material& material);
/// The number of these points.
Eigen::Index stress_points_of(mesh::Shape shape, int order);
/// The polynomial through values at these points, at the nodes.
/// @return [n_nodes x n_points]
Eigen::MatrixXd stresses_to_nodes(mesh::Shape shape, int order);
/// Von Mises' stress of each row of stresses, Pa.
Eigen::VectorXd von_mises(const Eigen::MatrixXd& stresses);

/// Points of a face of a solid, (r, s) in [-1, 1]^2 or of a triangle, and the shape functions of
/// its nodes (mesh::solid_faces) there.
struct FaceRule {
  Points points;
  Basis basis;
};

/// Exact for a pressure on a face with straight edges.
/// @param n_nodes  of the face
const FaceRule& face_rule(int n_nodes, int order);

/// Checks that `solid_frame` has an element of this shape and order.
/// @throws chladni::Error when it has none.
void check_solid_exists(mesh::Shape shape, int order);

}  // namespace chladni::plate
