#pragma once

#include "cases/reduce_steps.hpp"
#include "mbs_export/mass_integrals.hpp"

namespace chladni::cases {

/// The mass integrals of the FE model in the coordinates of the reduced system.
/// @note   Collective.
mbs_export::MassIntegrals mass_integrals(const plate::Structure& structure, const FeModel& fe,
                                         const SceneReduction& reduced);

}  // namespace chladni::cases
