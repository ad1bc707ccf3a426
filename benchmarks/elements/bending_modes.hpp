#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/plate_options.hpp"

namespace chladni::benchmarks {

/// `family`: the elements of this library; `serendipity`: the comparison, for blocks of order 2.
enum class Formulation { family, serendipity };

/// The lowest flexural modes of a plane plate clamped at the group "inner_edge".
struct BendingModes {
  int n_dofs;            ///< of the free nodes, three each: deflection and two rotations
  Eigen::VectorXd f_Hz;  ///< [n] ascending
  std::vector<int>
      n_diameters;             ///< [n] nodal diameters, from the deflection of the outermost nodes
  double assembly_s, modes_s;  ///< CPU time; the latter with the factorisation
};

/// Plane displacements and drilling rotations are held: flexure alone.
/// @throws chladni::Error when the eigen-solver does not converge.
BendingModes bending_modes(const mesh::Mesh& plate, Formulation formulation,
                           const plate::ShellSection& section, int n_modes);

}  // namespace chladni::benchmarks
