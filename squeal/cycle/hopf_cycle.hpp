#pragma once

#include <optional>

#include "squeal/cycle/branch_arc.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// The small cycle next to a Hopf point, as the first point of its branch. It starts from the
/// eigenvector at the stability limit with an amplitude that moves the first pad by a fiftieth of
/// its compression. Newton's method then finds its speed, on either side of the limit, and its
/// shape.
/// @param motion  motion of the brake as a function of the speed
/// @param limit   limit at which sliding loses or regains its stability over the speed
/// @return absent when the motion at the limit does not oscillate, or Newton's method does not
///         converge
std::optional<ArcPoint> cycle_at_hopf(const Brake& brake, const AutonomousMotionAt& motion,
                                      const StabilityPoint& limit);

}  // namespace chladni::squeal
