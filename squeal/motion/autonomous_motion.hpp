#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>

#include "squeal/brake/contact.hpp"
#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

/// An autonomous motion x' = f(x), with the functions that a search for periodic solutions needs.
class AutonomousMotion : public SwitchedMotion {
 public:
  virtual Eigen::Index size() const = 0;  ///< number of entries of x

  /// Highest angular frequency of the motion, rad/s; it limits the time steps.
  virtual double omega_highest() const = 0;

  /// Jacobian df/dx on the present sides, [size x size], 1/s.
  virtual Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) = 0;

  /// Contact state of the first pad pair at x by the full contact law.
  virtual ContactResult<double> first_contact(const Eigen::VectorXd& x) = 0;

  /// Number of evaluations of all contact forces so far. A derivative counts once for each
  /// direction, which is six for a disc, according to its cost.
  std::int64_t n_evaluations() const { return n_evaluations_; }

  /// f(x) with the sides that belong to x.
  Eigen::VectorXd rate_at(const Eigen::VectorXd& x)
  {
    const Eigen::VectorXd f = rate(0.0, x);
    return take_sides_of_rate() ? rate(0.0, x) : f;
  }

 protected:
  std::int64_t n_evaluations_ = 0;
};

/// The motion as a function of the speed (rad/s).
using AutonomousMotionAt = std::function<std::unique_ptr<AutonomousMotion>(double speed)>;

}  // namespace chladni::squeal
