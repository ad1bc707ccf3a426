#pragma once

#include "squeal/model_options.hpp"
#include "squeal/models/sliding_masses.hpp"

namespace chladni::squeal {

/// q = (x, y); the pad moves by y.
SlidingMasses sliding_masses(const Oscillator& oscillator);

Places places_in(Oscillator& oscillator);

/// Friction coefficient at which the frequencies of the undamped oscillator coincide and flutter
/// begins, mu = ((k_x - k_y - k_c)^2 / 4 + k_xy^2) / (k_xy k_c).
double flutter_friction(const Oscillator& oscillator);

}  // namespace chladni::squeal
