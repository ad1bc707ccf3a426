#pragma once

#include "squeal/model_options.hpp"
#include "squeal/models/model.hpp"

namespace chladni::squeal {

/// x = (x w, y w, x', y') with w^2 = k_x / m. The contact appears as both pads of a pair: `z` is y,
/// f_t the friction on the mass.
Model model_of(const Oscillator& oscillator);

/// The friction coefficient above which the two frequencies of the undamped oscillator coincide and
/// flutter sets in, mu = ((k_x - k_y - k_c)^2 / 4 + k_xy^2) / (k_xy k_c).
double flutter_friction(const Oscillator& oscillator);

}  // namespace chladni::squeal
