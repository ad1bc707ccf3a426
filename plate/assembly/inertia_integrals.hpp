#pragma once

#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/block_rows.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/elements/mass_points.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

/// The common data of integrals over the mass of a structure; refers to the arguments of
/// `mass_model`.
struct MassModel {
  const mesh::Mesh& mesh;
  const Structure& structure;
  const DofMap& dofs;
  MPI_Comm comm;
  SectionMap sections;
  Directors directors;
  std::vector<int> mass_nodes;  ///< node of each lumped mass
  std::vector<PointMass> masses;
  BlockPattern pattern;  ///< of the rows of this rank
};

/// Prepares the integrals. The arguments must outlive the result.
/// @note   Collective on `comm`.
/// @throws chladni::Error as `assemble`.
MassModel mass_model(const mesh::Mesh& mesh, const Structure& structure, const DofMap& dofs,
                     MPI_Comm comm);

/// S_kl = int N_k^T N_l dm of the displacements u_k = N_k d; M = S_xx + S_yy + S_zz. S_xy - S_yx
/// is, up to its factor, the Coriolis matrix of a spin about z.
/// @param k, l  0 to 2
/// @return [n x n] AIJ as System::M, unsymmetric for k != l; kg, kg m, kg m^2
/// @note   Collective on the communicator of the model.
petsc::Matrix displacement_product(const MassModel& model, int k, int l);

/// Two directions k, l, 0 to 2.
using Axes = std::pair<int, int>;

/// The same of several pairs of directions, in one pass over the elements.
std::vector<petsc::Matrix> displacement_products(const MassModel& model,
                                                 std::span<const Axes> axes);

/// Integrals of the positions x over the mass, about the origin of the mesh.
struct MassMoments {
  double mass;             ///< kg
  Eigen::Vector3d first;   ///< int x dm, kg m
  Eigen::Matrix3d second;  ///< int x x^T dm, kg m^2
  /// [n x 12] dense, rows as System::M. Columns 0 to 2 are int u_l dm, column 3 + 3 k + l is int
  /// x_k u_l dm.
  petsc::Matrix displacement;
};

/// Computes the integrals of positions and displacements.
/// @note   Collective on the communicator of the model.
MassMoments mass_moments(const MassModel& model);

/// Moments and displacement products, in one pass over the elements.
struct InertiaIntegrals {
  MassMoments moments;
  std::vector<petsc::Matrix> products;  ///< S_kl of each pair of axes
};

/// Computes both.
/// @note   Collective on the communicator of the model.
InertiaIntegrals inertia_integrals(const MassModel& model, std::span<const Axes> axes);

/// Mass points of an element, and the places where it has its DOFs.
struct PlacedPoints {
  MassPoints points;
  NodeVectors arms;  ///< [n x 3] m, from the nodes of the mesh to the DOFs; empty for zero
};

/// The mass points of an element of the model's mesh.
PlacedPoints element_points(const MassModel& model, const mesh::ElementBlock& block, int element);

/// Number of columns of MassMoments::displacement.
constexpr Eigen::Index n_moments = 12;

/// The contribution of an element to MassMoments::displacement: sums of (1, x) u_l dm over its
/// points.
/// @return [6 n_nodes x 12]
Eigen::MatrixXd element_moments(const MassPoints& points);

}  // namespace chladni::plate
