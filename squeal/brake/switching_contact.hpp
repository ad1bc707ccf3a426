#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

/// All contact points of a disc's pads, each pad on a smooth branch of its contact law
/// (contact_branch.hpp), with the compliance of modes without inertia. The owner knows the motion
/// and its frame: it sets `points()[i].S` and `motions()[i]`, then calls add_forces or derivatives.
class SwitchingContact {
 public:
  SwitchingContact(const RingCompliance& compliance, PadSystem pads, ContactLaw law, double speed);

  const PadSystem& pads() const { return pads_; }
  std::vector<BrakePoint>& points() { return points_; }
  /// Motions of the contact points; the owner sets the part of the modes with inertia, and the
  /// functions below add the others.
  std::vector<PointMotion>& motions() { return motions_; }

  /// Adds the contact forces on the present branches to the rates of the modes, and updates the
  /// switching functions.
  void add_forces(Eigen::Ref<Eigen::VectorXd> p_dot);

  /// Derivatives of these forces.
  /// @param n  number of coordinates
  StackedContact derivatives(Eigen::Index n);

  /// Contact states by the full contact law, one for each point.
  std::vector<ContactResult<double>> contacts();

  /// Axial force of each pad relative to its preload, upper and lower pad of each point in turn;
  /// empty when the law has one branch.
  const Eigen::VectorXd& switches() const { return S_; }
  double side(Eigen::Index i) const;  ///< side of switching function i: 1 or -1
  void set_side(Eigen::Index i, double side);

  std::vector<double>& branches() { return branches_; }  ///< branches, for an archive of the state

 private:
  void follow_on_branches();

  double speed_;
  double pulled_;  ///< branch of a pad whose axial force is negative
  PadSystem pads_;
  std::vector<BrakePoint> points_;
  ContactSeries series_;
  std::vector<PointMotion> motions_;
  std::vector<double> branches_;  ///< branch of the upper and the lower pad of each point
  Eigen::VectorXd S_;
};

}  // namespace chladni::squeal
