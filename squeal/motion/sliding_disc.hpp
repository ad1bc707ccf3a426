#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/switching_contact.hpp"
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

  double speed() const { return speed_; }                          ///< rad/s
  std::size_t n_pads() const { return contact_.pads().n_pads(); }  ///< pairs
  Eigen::Index size() const override { return A_.rows(); }
  double omega_highest() const override { return omega_.maxCoeff(); }

  const Eigen::VectorXd& rate(double t, const Eigen::VectorXd& x) override;
  const Eigen::VectorXd& switches() const override { return contact_.switches(); }
  double side(Eigen::Index i) const override { return contact_.side(i); }
  void set_side(Eigen::Index i, double side) override { contact_.set_side(i, side); }
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
  /// Motions of the contact points by the modes with inertia.
  void move_points(const Eigen::VectorXd& x);

  double speed_;
  SwitchingContact contact_;
  Eigen::VectorXd omega_;
  Eigen::MatrixXd A_;  ///< of the disc and the plates without contact, 1/s
  Eigen::VectorXd f_;
};

}  // namespace chladni::squeal
