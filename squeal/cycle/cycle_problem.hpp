#pragma once

#include <functional>

#include "squeal/brake/disc.hpp"
#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/model.hpp"
#include "squeal/motion/autonomous_motion.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Whatever squeals, as the search for its limit cycles needs to know it.
struct CycleProblem {
  AutonomousMotionAt motion;
  StateMatrixAt state_matrix;
  double compression;  ///< of the first pad at rest: displacement at which it would let go, m

  /// What is reported of an orbit at a speed (rad/s).
  std::function<DirectLimitCycle(AutonomousMotion& motion, const PeriodicOrbit& orbit,
                                 double speed)>
      measured;
};

/// @throws chladni::Error when the disc is not axisymmetric: in no frame its equations are then
///         free of time, and what follows the sliding disc has two frequencies.
CycleProblem cycle_problem(const Disc& disc, const SquealOptions& options);

/// Of a model without a body; there are no modes and no energies in what it reports.
CycleProblem cycle_problem(const Model& model);

}  // namespace chladni::squeal
