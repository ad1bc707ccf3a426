#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "squeal/cycle/branch_arc.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// The quantities of a cycle that a branch stores.
BranchPoint point_of(const DirectLimitCycle& cycle);

/// Follows parts of a branch of limit cycles along its arc, through folds, until it leaves a range
/// of speeds or ends at rest, and computes the cycles at the speeds of the range.
class BranchFollower {
 public:
  /// @param brake  must outlive this object
  BranchFollower(const Brake& brake, const SpeedRange& range);

  const AutonomousMotionAt& motion() const { return motion_; }

  /// Follows the branch from a cycle, which is not added to the points, towards lower (-1) or
  /// higher (1) speeds.
  LimitCycleBranch from_cycle(const DirectLimitCycle& start, double direction,
                              const Progress& progress) const;

  /// Follows the branch from a point in the direction of its tangent.
  LimitCycleBranch from_point(ArcPoint point, const Progress& progress) const;

  /// The quantities of the cycle at a point of the arc, without solving for it again at a fixed
  /// speed. It is used at folds and near rest, where Newton's method at one speed does not
  /// converge.
  /// @return absent when a contact switches endlessly
  std::optional<BranchPoint> as_it_is(const ArcPoint& point) const;

 private:
  double progress_at(double speed, double direction) const;

  /// Adds the cycles at the speeds of the range between two points of the arc, and the fold if
  /// there is one.
  void add_between(const ArcPoint& a, const ArcPoint& b, double length,
                   LimitCycleBranch& part) const;
  void add_speeds(const ArcPoint& a, const ArcPoint& b, LimitCycleBranch& part) const;
  void add(const CycleStart& near, double speed, std::vector<BranchPoint>& points) const;

  const Brake& brake_;
  AutonomousMotionAt motion_;
  SpeedRange range_;
  Eigen::VectorXd speeds_;
};

}  // namespace chladni::squeal
