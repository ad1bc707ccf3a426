#pragma once

#include "sound/tone.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/radiation.hpp"

namespace chladni::sound {

/// How far from the squeal the frequency of a mode may be to be taken for the one that squeals.
inline constexpr double near_squeal = 0.05;

/// What the air does to each of the modes of a body: the pressure of q' = 1 does the work
/// Z = integral of p conj(v_n), so that the equation of the mode gains Re(Z) q' and
/// Im(Z) / omega q''. It is evaluated at the frequency of the mode, but for modes near the squeal,
/// which the pads stiffen, at that of the squeal. Coupling of modes through the air is left out.
/// @param modes         0-based, those that `motion` has
/// @param squeal_omega  rad/s; 0 for none
/// @throws chladni::Error from plan_air.
/// @note MPI must be running.
squeal::Radiation radiation(const mbs_export::ModalBody& body, const Source& source,
                            const std::vector<int>& modes, double squeal_omega);

/// The mean over both modes of each pair whose radiation is the same by the symmetry of the
/// outline: all with nodal diameters around an axisymmetric one; with N holes at equal angles those
/// whose doubled number N does not divide. What they differ by is an error of the mesh.
squeal::Radiation even_over_pairs(squeal::Radiation radiation, const squeal::Disc& disc,
                                  const Outline& outline);

}  // namespace chladni::sound
