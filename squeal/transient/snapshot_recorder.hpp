#pragma once

#include <optional>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/motion/state_archive.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/transient_steps.hpp"

namespace chladni::squeal {

/// Records modal states while a transient runs: snapshots over the whole run and, for an
/// axisymmetric disc, all displacements of the tail in the inertial frame.
class SnapshotRecorder {
 public:
  /// @param inertial, run  must outlive the recorder
  SnapshotRecorder(const Disc& disc, const std::optional<InertialDisc>& inertial,
                   const RecordingPlan& plan, const TransientCase& run);

  /// Records sample i at time t (s), which is the present state of the steps.
  void add(std::int64_t i, double t, const ModalSteps& steps);

  /// The snapshots so far.
  Snapshots snapshots() const;
  /// The displacements for Transient::tail_a.
  Eigen::MatrixXd tail_a() const { return tail_a_.leftCols(n_tail_); }

  void exchange(StateArchive& archive);

 private:
  Eigen::VectorXd omega_;
  const std::optional<InertialDisc>& inertial_;
  RecordingPlan plan_;
  const TransientCase& run_;
  Snapshots snapshots_;  ///< allocated for the whole run
  Eigen::MatrixXd tail_a_;
  Eigen::Index n_tail_ = 0;
};

}  // namespace chladni::squeal
