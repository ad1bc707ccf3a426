#pragma once

#include <optional>

#include "squeal/disc.hpp"
#include "squeal/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Where the search for a periodic motion begins.
struct CycleStart {
  Eigen::VectorXd x;  ///< [2 n_modes] m kg^(1/2) / s; see SlidingDisc
  double period;      ///< s
};

/// The limit cycle at `speed` (rad/s) without a transient: Newton's method on x(T; x_0) - x_0 = 0
/// for x_0 and T, with the step of x_0 normal to the flow. It begins with the unstable eigenvector
/// of the sliding disc, first at twice the displacement at which a pad loses its force.
/// @throws chladni::Error when the disc is not axisymmetric, when it is stable at this speed, and
///         when no start leads to a periodic motion.
DirectLimitCycle limit_cycle_direct(const Disc& disc, const SquealOptions& options, double speed);

/// The same from a given start, such as the cycle at a speed nearby; absent when Newton's method
/// does not converge or ends at rest.
std::optional<DirectLimitCycle> limit_cycle_near(const Disc& disc, const SquealOptions& options,
                                                 double speed, const CycleStart& start);

}  // namespace chladni::squeal
