#pragma once

#include <span>

#include "plate/dof_map.hpp"

namespace chladni::plate {

/// Makes the reference nodes of averaging couplings move with their groups. With x_i the nodes of
/// the group, w_i their group_shares divided by the sum of these, c = sum w_i x_i and r_i = x_i -
/// c, the reference node has
///   theta_ref = J^-1 sum w_i r_i x u_i,   J = sum w_i (r_i^2 I - r_i r_i^T),
///   u_ref = sum w_i u_i + theta_ref x (x_ref - c),
/// the rigid motion that fits the u_i best. These six equations are solved for six of the u_i,
/// chosen by pivoting: they become combinations of the others and of the motion of the reference
/// node, whose DOFs take their places. The system keeps its size, and the reference node can be
/// loaded, held or be an attachment as any other.
/// @param map  numbered, with all references followed.
/// @throws chladni::Error when groups overlap or have no six independent displacements (fewer than
///         three nodes, or all of them on one line).
void average_motions(const mesh::Mesh& mesh, std::span<const Coupling> couplings, DofMap& map);

}  // namespace chladni::plate
