#pragma once

#include <optional>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/motion/oscillator_flow.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Initial state of `transient`: the pads at `angle` (rad) are displaced by
/// `initial_pad_displacement`.
ModalState transient_start(const Disc& disc, const std::optional<InertialDisc>& inertial,
                           const TransientCase& run, double angle);

}  // namespace chladni::squeal
