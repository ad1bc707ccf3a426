#pragma once

#include <vector>

#include "plate/elements/shell_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// Section forces of a shell at points, as tensors and vectors in the axes of the model, so that
/// they need no local frame. Symmetric tensors have the components xx, yy, zz, xy, yz, xz; they are
/// tangential to the mid-surface. n is the unit director and z the height along it.
struct ShellResultants {
  Eigen::MatrixXd N;  ///< [n_points x 6] membrane forces, int sigma dz, N/m
  Eigen::MatrixXd M;  ///< [n_points x 6] moments, int sigma z dz, N; positive: tension at +n
  Eigen::MatrixXd Q;  ///< [n_points x 3] transverse shear forces, int tau dz with tau = P sigma n,
                      ///< N/m
};

/// The points where section forces are most accurate: Gauss p x p of an element of order p.
Points resultant_points(mesh::Shape shape, int order);

/// Section forces from the displacements of the nodes, with the strains of the stiffness matrix:
/// assumed membrane and shear strains, compatible bending.
/// @param nodes  D is half the thickness times the unit director
/// @param u_e    [6 n_nodes] displacements and rotations of the mid-surface, m, rad
/// @return at `resultant_points`
/// @throws chladni::Error for an order that does not exist.
ShellResultants shell_resultants(mesh::Shape shape, int order, const ShellNodes& nodes,
                                 const Material& material, const Eigen::VectorXd& u_e);

/// Section forces as by `shell_resultants` for several displacements.
/// @param U_e  [6 n_nodes x n] one in each column
/// @return [n]
std::vector<ShellResultants> shell_resultants_of(mesh::Shape shape, int order,
                                                 const ShellNodes& nodes, const Material& material,
                                                 const Eigen::MatrixXd& U_e);

/// The matrix from values at `resultant_points` to values at the nodes, by the polynomial of order
/// p - 1 through them (quadrilaterals) or nearest to them (triangles).
/// @return [n_nodes x n_points]
Eigen::MatrixXd extrapolation_to_nodes(mesh::Shape shape, int order);

}  // namespace chladni::plate
