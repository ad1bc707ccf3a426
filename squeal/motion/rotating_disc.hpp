#pragma once

#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/point_shapes.hpp"
#include "squeal/brake/switching_contact.hpp"
#include "squeal/motion/motion.hpp"
#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// The motion of any disc between pads in the frame that rotates with it:
/// q'' + C q' + diag(omega^2) q = Q(t, q, q'), the modes of pads with a mass after those of the
/// disc. Switching functions are the axial forces S of the contact points over their preloads,
/// upper and lower one of each pair in turn.
class RotatingDisc final : public Motion {
 public:
  RotatingDisc(const Disc& disc, const SquealOptions& options, double speed);

  const Eigen::VectorXd& omega() const override { return omega_; }
  const Eigen::VectorXd& rate(double t, const Eigen::VectorXd& y) override;
  const Eigen::VectorXd& switches() const override { return contact_.switches(); }
  double side(Eigen::Index i) const override { return contact_.side(i); }
  void set_side(Eigen::Index i, double side) override { contact_.set_side(i, side); }
  Tangent tangent(double t, const Eigen::VectorXd& y) override;

  /// The contacts at (t, y) as the contact law has them, one for each pair.
  std::vector<ContactResult<double>> contacts(double t, const Eigen::VectorXd& y);

  /// To which of the pads, upper and lower one of each pair in turn, the switching function i
  /// belongs.
  int pad_of(Eigen::Index i) const;

  /// Evaluations of the contact forces of all pads so far; a tangent counts as six.
  std::int64_t n_evaluations() const { return n_evaluations_; }

  void exchange(StateArchive& archive) { archive(contact_.branches(), n_evaluations_); }

 private:
  /// Shapes of the contact points at time t, and their motions by the modes with inertia.
  void move_points(double t, const Eigen::VectorXd& y);

  double speed_;
  SwitchingContact contact_;  ///< with the shapes where the disc stood last
  Eigen::VectorXd omega_;
  Eigen::MatrixXd C_;
  bool damped_;
  PointShapes shapes_;
  Eigen::VectorXd f_;
  Eigen::VectorXd q_;
  std::int64_t n_evaluations_ = 0;
};

}  // namespace chladni::squeal
