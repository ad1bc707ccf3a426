#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

/// All contact points of a disc's pads, each pad on a smooth branch of its contact law
/// (contact_branch.hpp), with what modes without inertia do between. Its owner knows the motion and
/// in which frame: it sets `points()[i].S` and `motions()[i]`, then asks for forces or derivatives.
class SwitchingContact {
 public:
  SwitchingContact(const RingCompliance& compliance, PadSystem pads, ContactLaw law, double speed);

  const PadSystem& pads() const { return pads_; }
  std::vector<BrakePoint>& points() { return points_; }
  /// Of the modes with inertia, until a function below adds the others.
  std::vector<PointMotion>& motions() { return motions_; }

  /// Adds the forces on the present branches to the rates of the modes, and takes the switching
  /// functions.
  void add_forces(Eigen::Ref<Eigen::VectorXd> p_dot);

  /// Derivatives of these forces.
  /// @param n  coordinates
  StackedContact derivatives(Eigen::Index n);

  /// The contacts as the law has them, one for each point.
  std::vector<ContactResult<double>> contacts();

  /// Axial forces over their preloads, upper and lower one of each point in turn; none where the
  /// law has one branch.
  const Eigen::VectorXd& switches() const { return S_; }
  double side(Eigen::Index i) const;
  void set_side(Eigen::Index i, double side);

  std::vector<double>& branches() { return branches_; }  ///< for an archive of the state

 private:
  void follow_on_branches();

  double speed_;
  double pulled_;  ///< branch of a pad whose axial force is negative
  PadSystem pads_;
  std::vector<BrakePoint> points_;
  ContactSeries series_;
  std::vector<PointMotion> motions_;
  std::vector<double> branches_;  ///< of each point, upper and lower
  Eigen::VectorXd S_;
};

}  // namespace chladni::squeal
