#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>

#include "squeal/brake/contact.hpp"
#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

/// A motion x' = f(x) that does not depend on time, with what is needed to find its periodic
/// solutions.
class AutonomousMotion : public SwitchedMotion {
 public:
  virtual Eigen::Index size() const = 0;  ///< of x

  /// The highest angular frequency of the motion, rad/s: it bounds the steps.
  virtual double omega_highest() const = 0;

  /// df/dx [size x size] on the present sides, 1/s.
  virtual Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) = 0;

  /// The first pad pair at x, as the contact law has it.
  virtual ContactResult<double> first_contact(const Eigen::VectorXd& x) = 0;

  /// Evaluations of the contact forces of all pads so far. A derivative counts as one for each
  /// direction, six for a disc, which is what it costs.
  std::int64_t n_evaluations() const { return n_evaluations_; }

  /// f(x) with the contact law as it is at x.
  Eigen::VectorXd rate_at(const Eigen::VectorXd& x)
  {
    const Eigen::VectorXd f = rate(0.0, x);
    return take_sides_of_rate() ? rate(0.0, x) : f;
  }

 protected:
  std::int64_t n_evaluations_ = 0;
};

/// The motion at a speed (rad/s).
using AutonomousMotionAt = std::function<std::unique_ptr<AutonomousMotion>(double speed)>;

}  // namespace chladni::squeal
