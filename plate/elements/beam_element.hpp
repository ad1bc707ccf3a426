#pragma once

#include <Eigen/Core>

#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/element_matrices.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The local axes e_x, e_y, e_z of a straight beam as rows.
/// @param along  from the first node to the second, m
/// @throws chladni::Error when `along` vanishes, or when y and z of the section differ and its
///         orientation is missing or parallel to the beam.
Eigen::Matrix3d beam_axes(const Eigen::RowVector3d& along, const BeamSection& section);

/// K_e and M_e of straight two-node beams, one between each node and the next: a line of order p is
/// a chain of p beams. K_e is exact in statics for loads at the nodes. Deflection w and rotation
/// beta are interpolated by the solution of the unloaded beam with Phi = 12 EI / (kappa G A l^2),
/// Phi = 0 for Bernoulli and Euler. M_e is consistent with these functions, with rotary inertia rho
/// I and torsional inertia rho (I_y + I_z).
/// @param x  [n x 3] nodes from end to end, m
/// @throws chladni::Error as `beam_axes`.
/// Source: Przemieniecki, Theory of Matrix Structural Analysis (1968), sections 5.6 and 11.3;
/// Friedman and Kosmatka, Comput. Struct. 47 (1993) 473.
ElementMatrices beam_matrices(const NodeVectors& x, const BeamSection& section);

/// Displacement and rotation (u, theta) of the section at xi in [0, 1] of one beam, in its local
/// axes, as linear forms in the DOFs of its two nodes; the interpolation of `beam_matrices`.
/// @param along  from the first node to the second, m
Eigen::Matrix<double, 6, 12> beam_shapes(double xi, const Eigen::RowVector3d& along,
                                         const BeamSection& section);

/// Section forces at both ends of each beam of a line, as linear forms S_e in the DOFs of its
/// nodes: force (N, Q_y, Q_z) and moment (M_x, M_y, M_z) in the local axes, which act on the face
/// with the normal +x. Q_z = dM_y/dx, Q_y = -dM_z/dx.
/// @param x  [n x 3] nodes from end to end, m
/// @return [12 (n - 1) x 6 n]: first end, second end of each beam; N, N m per m or rad
Eigen::MatrixXd beam_section_forces(const NodeVectors& x, const BeamSection& section);

}  // namespace chladni::plate
