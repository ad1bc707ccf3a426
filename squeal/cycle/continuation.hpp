#pragma once

#include <Eigen/Core>

#include <optional>

#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal {

/// A periodic motion on its branch over the speed, with the tangent of the branch.
struct ArcPoint {
  CycleStart at;
  double speed;  ///< rad/s
  /// [size + 2] unit tangent of the branch in the coordinates (x / |x|, ln T, ln speed).
  Eigen::VectorXd tangent;
};

/// The orbit at `at` and `speed` as a point of its branch; absent when it cannot be computed.
/// @param direction  -1 towards lower speeds, 1 towards higher ones
std::optional<ArcPoint> arc_point(const AutonomousMotionAt& motion, const CycleStart& at,
                                  double speed, double direction);

/// The point at the arc length `length` farther along the branch, by Keller's pseudo-arclength
/// continuation: a predictor step along the tangent, then Newton's method for (x, T, speed) in the
/// plane normal to it, which remains regular at a fold. Derivatives by the speed are differences.
/// @return absent when Newton's method does not converge within a few steps
std::optional<ArcPoint> next_on_arc(const AutonomousMotionAt& motion, const ArcPoint& point,
                                    double length);

/// Corrector of the continuation: the point of the branch near `near` in the plane normal to its
/// tangent, by Newton's method.
/// @param largest_change  largest allowed step, in the coordinates of the tangent
/// @return absent when Newton's method does not converge
std::optional<ArcPoint> corrected(const AutonomousMotionAt& motion, const ArcPoint& near,
                                  double largest_change);

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
