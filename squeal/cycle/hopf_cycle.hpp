#pragma once

#include <optional>

#include "squeal/cycle/branch_arc.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// The small cycle beside a Hopf point, as a point of its branch on the way to larger ones. It
/// begins with the eigenvector of the oscillation at the limit, which moves the first pad by a
/// fiftieth of its compression; Newton's method finds its speed, on either side of the limit, and
/// its shape at this amplitude.
/// @param motion  of the brake
/// @param limit   where its sliding loses or regains its stability over the speed
/// @return absent when the motion at the limit does not oscillate, and when Newton's method does
/// not
///         converge.
std::optional<ArcPoint> cycle_at_hopf(const Brake& brake, const AutonomousMotionAt& motion,
                                      const StabilityPoint& limit);

}  // namespace chladni::squeal
