#pragma once

#include "sound/tone.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/radiation.hpp"

namespace chladni::sound {

/// Relative frequency distance below which a mode counts as a mode of the squeal.
inline constexpr double near_squeal = 0.05;

/// Radiation damping and added mass of each mode of a body. For q' = 1 the pressure does the work
/// Z = integral of p conj(v_n), so that the modal equation gains the terms Re(Z) q' and
/// Im(Z) / omega q''. Z is evaluated at the mode's frequency, or at the squeal frequency for modes
/// near it, which the pads stiffen. Coupling of modes through the air is neglected.
/// @param modes         0-based numbers of the modes in `source.motion`
/// @param squeal_omega  rad/s; 0 for none
/// @throws chladni::Error from plan_air.
/// @note MPI must be initialised.
squeal::Radiation radiation(const mbs_export::ModalBody& body, const Source& source,
                            const std::vector<int>& modes, double squeal_omega);

/// Replaces the radiation of both modes of a pair by their mean when symmetry makes them equal: for
/// all pairs with n > 0 nodal diameters of an axisymmetric outline; for an outline with N holes at
/// equal angles, for those where N does not divide 2 n. The difference within such a pair is an
/// error of the mesh.
squeal::Radiation even_over_pairs(squeal::Radiation radiation, const squeal::Disc& disc,
                                  const Outline& outline);

}  // namespace chladni::sound
