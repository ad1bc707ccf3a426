#pragma once

#include <Eigen/Core>
#include <functional>

#include "squeal/brake/contact.hpp"
#include "squeal/motion/autonomous_motion.hpp"

namespace chladni::squeal {

/// A of x' = A x about the sliding equilibrium, at a speed (rad/s).
using StateMatrixAt = std::function<Eigen::MatrixXd(double speed)>;

/// A brake as a few autonomous differential equations x' = f(x; speed) with the sliding equilibrium
/// at x = 0. Everything that an analysis needs to know of it, whatever it is made of.
struct Model {
  Eigen::Index size;  ///< of x

  /// df/dx at x = 0. Entries 1/s when x is scaled to energy, e.g. (omega q, q').
  StateMatrixAt state_matrix;

  /// f(x; speed)
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x, double speed)> rate;

  /// f with switching contact, for the search of periodic motions; empty where there is none.
  AutonomousMotionAt motion;

  /// The first pad pair at x.
  std::function<ContactResult<double>(const Eigen::VectorXd& x, double speed)> contact;

  /// A state at rest with the first pads displaced by so much, m.
  std::function<Eigen::VectorXd(double displacement)> start;

  double rest_height;       ///< z of the first upper pad at x = 0, m
  double rest_compression;  ///< of its spring: displacement at which it would let go, m
};

}  // namespace chladni::squeal
