#pragma once

#include <Eigen/Core>

#include "common/petsc.hpp"
#include "mesh/mesh.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The strain energy u_e^T K_e u_e / 2 of each element in each motion.
/// @param motions  [6 n x k] m, rad; row 6 i + c is component c of node i. Rows behind those of the
///                 nodes of the mesh have no influence.
/// @return [n_elements x k] J, by blocks; on every rank
/// @note   Collective on `comm`, over which the elements are divided.
Eigen::MatrixXd element_energies(const mesh::Mesh& mesh, const Structure& structure,
                                 const Eigen::MatrixXd& motions, MPI_Comm comm);

}  // namespace chladni::plate
