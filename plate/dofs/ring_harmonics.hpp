#pragma once

#include <algorithm>

#include "plate/dofs/average_motions.hpp"

namespace chladni::plate {

/// A circumferential harmonic of a ring: cos(n phi), or sin(n phi).
struct Harmonic {
  int order;  ///< n
  bool is_sine;
};

/// Harmonic k in the order 1, cos(phi), sin(phi), cos(2 phi), ...
constexpr Harmonic harmonic_of(int k)
{
  return {.order = (k + 1) / 2, .is_sine = k > 0 && k % 2 == 0};
}

/// A ring that has the harmonics of its motion as DOFs.
struct HarmonicRing {
  std::string name;
  int up_to;                 ///< highest harmonic that is asked for as a master
  std::vector<int> nodes;    ///< [N] in the order of their angle
  std::vector<int> numbers;  ///< [N] active number of each harmonic k

  /// Number of harmonics 0 .. up_to with cosine and sine that N nodes can distinguish.
  int n_wanted() const { return std::min(2 * up_to + 1, static_cast<int>(nodes.size())); }
};

/// Nodes with harmonic rings. The DOFs of the harmonics of a ring take the places of those of its
/// nodes.
struct RingMotions : NodeMotions {
  std::vector<HarmonicRing> rings;
};

/// Replaces the DOFs of the nodes of rings by their harmonics. With unit vectors E_i = (e_r, e_t,
/// e_a) at node i, radial, tangential and along the axis of the circle, and the coordinates c_k =
/// (u_r, u_t, u_a, theta_r, theta_t, theta_a) of harmonic k,
///   (u, theta)_i = sum_k F_ik diag(E_i, E_i) c_k,  F_ik = a_n cos(n phi_i) or a_n sin(n phi_i)
/// for all n = 0 .. floor(N / 2). F is orthogonal, so this is another basis of the same space, and
/// harmonics beyond `up_to` are DOFs like any other. In these components a harmonic of the ring
/// belongs to motions of an axisymmetric body with the same number of nodal diameters. The axis
/// points to the side of its largest component; phi counts from the projection of the x axis, or of
/// the y axis where x is nearly the axis.
/// @throws chladni::Error for a name that is no group, fewer than three nodes, nodes that are not
///         equally spaced on a circle, nodes that follow others or are averaged, rings with a
///         common node, and a harmonic that the nodes cannot represent.
RingMotions with_ring_harmonics(const mesh::Mesh& mesh, NodeMotions motions,
                                std::span<const RingHarmonics> rings);

}  // namespace chladni::plate
