#pragma once

#include <span>

#include "mesh/mesh.hpp"
#include "plate/dof_map.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// Gives the nodes of rings their harmonics as DOFs. With unit vectors E_i = (e_r, e_t, e_a) at
/// node i, radial, tangential and along the axis of the circle, and the coordinates c_k = (u_r,
/// u_t, u_a, theta_r, theta_t, theta_a) of harmonic k,
///   (u, theta)_i = sum_k F_ik diag(E_i, E_i) c_k,  F_ik = a_n cos(n phi_i) or a_n sin(n phi_i)
/// for all n = 0 .. floor(N / 2). F is orthogonal, so that this is another basis of the same space:
/// nothing is lost, and harmonics beyond `up_to` are DOFs like any other. In these components a
/// harmonic of the ring belongs to the same number of nodal diameters of an axisymmetric body.
/// The axis points to the side of its largest component; phi counts from the projection of the x
/// axis, or of the y axis where x is nearly the axis.
/// @throws chladni::Error for a name that is no group, fewer than three nodes, nodes that are not
///         equally spaced on a circle, that follow others or are averaged, rings with a node in
///         common, a harmonic that so few nodes cannot show, and nodes without all six DOFs.
DofMap with_ring_harmonics(const mesh::Mesh& mesh, DofMap dofs,
                           std::span<const RingHarmonics> rings);

}  // namespace chladni::plate
