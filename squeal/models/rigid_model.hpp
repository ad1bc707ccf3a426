#pragma once

#include "squeal/models/model.hpp"
#include "squeal/models/rigid_disc.hpp"

namespace chladni::squeal {

/// The rigid disc as a model: x = (w q, q') with w^2 = k_t / Theta, and with Drive::moment a fifth
/// entry, the deviation of the spin from the speed (rad/s), which the linearisation leaves alone.
Model model_of(const RigidDisc& disc, Drive drive, RigidEquations equations);

}  // namespace chladni::squeal
