#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/plate_options.hpp"

namespace chladni::benchmarks {

/// The elements to compare: `family` is this library's own; `serendipity` is the 8-node
/// quadrilateral or 6-node triangle (serendipity.hpp) on blocks of order 2.
enum class Formulation { family, serendipity };

/// The lowest flexural modes of a plane plate clamped at the group "inner_edge".
struct BendingModes {
  int n_dofs;            ///< DOFs of the free nodes, three per node: deflection and two rotations
  Eigen::VectorXd f_Hz;  ///< [n] natural frequencies, ascending
  std::vector<int> n_diameters;  ///< [n] nodal diameters of the modes, from the outermost nodes
  double assembly_s, modes_s;    ///< CPU time, s; `modes_s` includes the factorisation
};

/// The lowest `n_modes` bending modes of a plate clamped at the group "inner_edge". In-plane
/// displacements and drilling rotations are held at zero.
/// @throws chladni::Error when the eigensolver does not converge.
BendingModes bending_modes(const mesh::Mesh& plate, Formulation formulation,
                           const plate::ShellSection& section, int n_modes);

}  // namespace chladni::benchmarks
