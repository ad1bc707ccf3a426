#pragma once

#include "squeal/model_options.hpp"
#include "squeal/models/sliding_masses.hpp"

namespace chladni::squeal {

/// q = (x_1, x_2) of pad and disc; the pad moves by x_1. The normal force is constant.
SlidingMasses sliding_masses(const TwoMasses& masses);

Places places_in(TwoMasses& masses);

}  // namespace chladni::squeal
