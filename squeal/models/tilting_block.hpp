#pragma once

#include "squeal/model_options.hpp"
#include "squeal/models/sliding_masses.hpp"

namespace chladni::squeal {

/// q = (x, y, phi) of the centre of mass; the pad moves by y. The two ends of the foot are the
/// contact points, of which either may let go.
SlidingMasses sliding_masses(const TiltingBlock& block);

Places places_in(TiltingBlock& block);

}  // namespace chladni::squeal
