#pragma once

#include "squeal/models/model.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// The motion of a model after a small displacement of its first pads, by steps of order 8. Where a
/// contact opens or closes within a step, that step is of first order.
/// @throws chladni::Error for a speed of zero, a duration or an initial displacement that is not
///         positive, and too few steps for the highest frequency.
Transient transient(const Model& model, const TransientCase& run, const Keeping& keeping = {});

/// Growth of a small disturbance at `speed` (rad/s) over `duration` (s), far below contact loss.
Growth growth(const Model& model, double speed, double duration);

}  // namespace chladni::squeal
