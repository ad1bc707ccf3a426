#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/petsc.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/block_rows.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/sections/section_map.hpp"

namespace chladni::plate {

/// What integrals over the mass of a structure have in common; refers to its arguments.
struct MassModel {
  const mesh::Mesh& mesh;
  const Structure& structure;
  const DofMap& dofs;
  MPI_Comm comm;
  SectionMap sections;
  NodeVectors normals;
  std::vector<int> mass_nodes;  ///< node of each lumped mass
  std::vector<PointMass> masses;
  BlockPattern pattern;  ///< of this rank
};

/// @note   Collective on `comm`.
/// @throws chladni::Error as `assemble`.
MassModel mass_model(const mesh::Mesh& mesh, const Structure& structure, const DofMap& dofs,
                     MPI_Comm comm);

/// S_kl = int N_k^T N_l dm of the displacements u_k = N_k d, the parts of which M = S_xx + S_yy +
/// S_zz is the sum. S_xy - S_yx is the Coriolis matrix of a spin about z, up to its factor.
/// @param k, l  0 to 2
/// @return [n x n] AIJ as System::M, unsymmetric for k != l, kg, kg m, kg m^2
/// @note   Collective on the communicator of the model.
petsc::Matrix displacement_product(const MassModel& model, int k, int l);

/// Integrals of the positions x over the mass, about the origin of the mesh.
struct MassMoments {
  double mass;             ///< kg
  Eigen::Vector3d first;   ///< int x dm, kg m
  Eigen::Matrix3d second;  ///< int x x^T dm, kg m^2
  /// [n x 12] dense, rows as System::M: columns 0 to 2 int u_l dm, 3 + 3 k + l int x_k u_l dm
  petsc::Matrix displacement;
};

/// @note   Collective on the communicator of the model.
MassMoments mass_moments(const MassModel& model);

}  // namespace chladni::plate
