#pragma once

#include <Eigen/Core>

#include <memory>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/switching_contact.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

/// Motion of any disc between pads in the frame that rotates with it,
/// q'' + C q' + diag(omega^2) q = Q(t, q, q'). The modes of pads with a mass follow those of the
/// disc. The switching functions are the axial forces S of the contact points relative to their
/// preloads, upper and lower pad of each pair in turn.
class RotatingDisc final : public Motion {
 public:
  RotatingDisc(const Disc& disc, const SquealOptions& options, double speed);

  const Eigen::VectorXd& omega() const override { return omega_; }
  const Eigen::VectorXd& rate(double t, const Eigen::VectorXd& y) override;
  const Eigen::VectorXd& switches() const override { return contact_.switches(); }
  double side(Eigen::Index i) const override { return contact_.side(i); }
  void set_side(Eigen::Index i, double side) override { contact_.set_side(i, side); }
  Tangent tangent(double t, const Eigen::VectorXd& y) override;

  /// Contact states at (t, y) by the full contact law, one for each pad pair.
  std::vector<ContactResult<double>> contacts(double t, const Eigen::VectorXd& y);

  /// The pad of the switching function i; upper and lower pad of each pair are counted in turn.
  int pad_of(Eigen::Index i) const;

  /// Number of evaluations of all contact forces so far; a tangent counts as six.
  std::int64_t n_evaluations() const { return n_evaluations_; }

 private:
  /// Sets the shapes of the contact points at time t, and their motions by the modes with inertia.
  void move_points(double t, const Eigen::VectorXd& y);

  double speed_;
  SwitchingContact contact_;  ///< with the shapes at the last angle of the disc
  Eigen::VectorXd omega_;
  Eigen::MatrixXd C_;
  bool damped_;
  PointShapes shapes_;
  Eigen::VectorXd f_;
  Eigen::VectorXd q_;
  std::int64_t n_evaluations_ = 0;
};

/// Motion of an axisymmetric disc between pads in the inertial frame, x' = f(x) with
/// x = (diag(omega) a, p) in m kg^(1/2) / s; modes of pads with a mass follow at the end of a and
/// p. f is smooth except where the axial force of a pad crosses zero. The switching functions are
/// these forces relative to their preloads, upper and lower pad of each point pair in turn.
class SlidingDisc final : public AutonomousMotion {
 public:
  SlidingDisc(const InertialDisc& disc, const SquealOptions& options, double speed);

  double speed() const { return speed_; }                          ///< rad/s
  std::size_t n_pads() const { return contact_.pads().n_pads(); }  ///< number of pad pairs
  Eigen::Index size() const override { return A_.rows(); }
  double omega_highest() const override { return omega_.maxCoeff(); }

  const Eigen::VectorXd& rate(double t, const Eigen::VectorXd& x) override;
  const Eigen::VectorXd& switches() const override { return contact_.switches(); }
  double side(Eigen::Index i) const override { return contact_.side(i); }
  void set_side(Eigen::Index i, double side) override { contact_.set_side(i, side); }
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) override;
  ContactResult<double> first_contact(const Eigen::VectorXd& x) override;

  /// Power of each source on the vibration, W; see CycleEnergy.
  struct Power {
    Eigen::VectorXd friction;  ///< [n_pads]
    Eigen::VectorXd normal;    ///< [n_pads]
    Eigen::VectorXd heat;      ///< [n_pads]
    double damping;
  };

  /// Observable quantities at the state x.
  struct Sample {
    ContactResult<double> first;  ///< contact state of the first pad pair
    Power power;
  };
  /// The observable quantities at the state x.
  Sample sample(const Eigen::VectorXd& x);

 private:
  /// Sets the motions of the contact points by the modes with inertia.
  void move_points(const Eigen::VectorXd& x);

  double speed_;
  SwitchingContact contact_;
  Eigen::VectorXd omega_;
  Eigen::MatrixXd A_;  ///< state matrix of disc and plates without contact, 1/s
  Eigen::VectorXd f_;
};

}  // namespace chladni::squeal
