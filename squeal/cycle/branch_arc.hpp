#pragma once

#include <Eigen/Core>
#include <optional>

#include "squeal/cycle/periodic_orbit.hpp"

namespace chladni::squeal {

/// A periodic motion on its branch over the speed, with the direction in which the branch goes on.
struct ArcPoint {
  CycleStart at;
  double speed;  ///< rad/s
  /// [size + 2] unit vector along the branch in the coordinates (x / |x|, ln T, ln speed).
  Eigen::VectorXd tangent;
};

/// The orbit at `at` and `speed` as a point of its branch.
/// @param direction  -1 towards lower speeds, 1 towards higher ones
std::optional<ArcPoint> arc_point(const AutonomousMotionAt& motion, const CycleStart& at,
                                  double speed, double direction);

/// The point that is `length` farther along the branch: a step along the tangent, then Newton's
/// method for (x, T, speed) in the plane normal to it, which does not mind a fold (Keller's
/// pseudo-arclength). Derivatives by the speed are differences.
/// @return absent when Newton's method does not converge within a few steps.
std::optional<ArcPoint> next_on_arc(const AutonomousMotionAt& motion, const ArcPoint& point,
                                    double length);

/// The point of the branch near `near` in the plane normal to its tangent, by Newton's method.
/// @param largest_change  of one of its steps, in the coordinates of the tangent
std::optional<ArcPoint> corrected(const AutonomousMotionAt& motion, const ArcPoint& near,
                                  double largest_change);

}  // namespace chladni::squeal
