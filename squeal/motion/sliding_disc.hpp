#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/motion/autonomous_motion.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The motion of an axisymmetric disc between pads in the inertial frame, x' = f(x) with
/// x = (diag(omega) a, p), pads with a mass at the end of a and p, all of the unit m kg^(1/2) / s.
/// f is smooth but where the axial force of a pad passes zero; switching functions are these forces
/// over their preloads, upper and lower one of each point pair in turn.
class SlidingDisc final : public AutonomousMotion {
 public:
  SlidingDisc(const InertialDisc& disc, const SquealOptions& options, double speed);

  double speed() const { return speed_; }                ///< rad/s
  std::size_t n_pads() const { return pads_.n_pads(); }  ///< pairs
  Eigen::Index size() const override { return A_.rows(); }
  double omega_highest() const override { return omega_.maxCoeff(); }

  const Eigen::VectorXd& rate(double t, const Eigen::VectorXd& x) override;
  const Eigen::VectorXd& switches() const override { return S_; }
  double side(Eigen::Index i) const override;
  void set_side(Eigen::Index i, double side) override;
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) override;
  ContactResult<double> first_contact(const Eigen::VectorXd& x) override;

  /// Power (W) of each source on the vibration; see CycleEnergy.
  struct Power {
    Eigen::VectorXd friction;  ///< [n_pads]
    Eigen::VectorXd normal;    ///< [n_pads]
    Eigen::VectorXd heat;      ///< [n_pads]
    double damping;
  };

  /// What can be seen of the state x.
  struct Sample {
    ContactResult<double> first;  ///< of the first pad pair
    Power power;
  };
  Sample sample(const Eigen::VectorXd& x);

 private:
  PointMotion motion_at(const BrakePoint& point, const Eigen::VectorXd& x) const;
  /// Of all points on the present branches, with what modes without inertia do.
  const std::vector<PointMotion>& motions(const Eigen::VectorXd& x);

  double speed_;
  double pulled_;  ///< branch of a pad whose axial force is negative
  PadSystem pads_;
  Eigen::VectorXd omega_;
  Eigen::MatrixXd A_;  ///< of the disc and the plates without contact, 1/s
  std::vector<BrakePoint> points_;
  ContactSeries series_;
  std::vector<PointMotion> motions_;
  std::vector<double> branches_;  ///< of each point; see contact_branch.hpp
  Eigen::VectorXd S_;
  Eigen::VectorXd f_;
};

}  // namespace chladni::squeal
