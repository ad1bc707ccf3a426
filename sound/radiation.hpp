#pragma once

#include "sound/air_plan.hpp"
#include "sound/surface_motion.hpp"
#include "squeal/radiation.hpp"

namespace chladni::sound {

/// What the air does to each of the modes of a body, at the frequency of the mode: the pressure of
/// q' = 1 does the work Z = integral of p conj(v_n), so that q'' + ... gains Re(Z) q' and
/// Im(Z) / omega q''. Coupling of modes through the air is left out.
/// @param modes  0-based, those that `motion` has
/// @throws chladni::Error from plan_air.
/// @note MPI must be running.
squeal::Radiation radiation(const mbs_export::ModalBody& body, const ThickBody& thick,
                            const SurfaceMotion& motion, const std::vector<int>& modes,
                            const AirOptions& air);

}  // namespace chladni::sound
