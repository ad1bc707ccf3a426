#pragma once

#include <Eigen/Core>

#include "plate/elements/beam_fields.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/element_matrices.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// K_e and M_e of a line of order p = n - 1 with the fields of `beam_fields`. Two nodes are exact
/// in statics for loads at them, and so is a straight line of any order for loads at its ends. M_e
/// is consistent with K_e, with rotary inertia rho I and torsional inertia rho (I_y + I_z).
/// @param x  [n x 3] nodes from end to end, m
/// @throws chladni::Error as `beam_fields`.
/// Source: Przemieniecki, Theory of Matrix Structural Analysis (1968), sections 5.6 and 11.3, for
/// two nodes.
ElementMatrices beam_matrices(const NodeVectors& x, const BeamSection& section,
                              LineFields fields = LineFields::best);

/// Section forces at the nodes of a line, as linear forms S_e in the DOFs of its nodes: force (N,
/// Q_y, Q_z) and moment (M_x, M_y, M_z) in the axes of `node_axes`, which act on the face with the
/// normal +x. Q_z = dM_y/dx, Q_y = -dM_z/dx.
/// @param x  [n x 3] nodes from end to end, m
/// @return [6 n x 6 n] each node in turn; N, N m per m or rad
Eigen::MatrixXd beam_section_forces(const NodeVectors& x, const BeamSection& section,
                                    LineFields fields = LineFields::best);

}  // namespace chladni::plate
