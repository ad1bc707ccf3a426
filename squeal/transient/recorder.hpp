#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/transient/resampling.hpp"
#include "squeal/transient/transient_steps.hpp"

namespace chladni::squeal {

/// Finds the largest |x| among the peaks of a sampled oscillation, each refined by a parabola.
class PeakFinder {
  /// Adds the next sample, at time `t` (s).
  /// @param step  distance of the samples, s
 public:
  /// The next sample, at time `t`; samples are `step` apart (s).
  void add(double t, double x, double step);

  /// A peak: its time and |x|.
  struct Peak {
    double t;
    double value;
  };
  /// The largest peak since the last call; absent when there was none.
  std::optional<Peak> take();

 private:
  double before_ = 0.0;
  double last_ = 0.0;
  int n_seen_ = 0;
  std::optional<Peak> largest_;
};

/// Amount of data recorded of a run with `n_steps` steps.
struct RecordingPlan {
  double step;  ///< s
  std::int64_t n_steps;
  std::int64_t window;          ///< steps per point of the envelope
  std::int64_t n_fine_windows;  ///< number of points with this window, before `late_window` applies
  std::int64_t late_window;     ///< steps per point of the envelope afterwards
  Decimation history;           ///< decimation of the history
  std::int64_t n_tail;          ///< number of steps in the tail
};

/// The state of the pads at a sample.
struct Sample {
  std::int64_t i;                                      ///< index, from 0
  double t;                                            ///< s
  double speed;                                        ///< rotation speed, rad/s
  const std::vector<ContactResult<double>>& contacts;  ///< one for each pad pair
};

/// Records the results of a transient while it runs.
class Recorder {
 public:
  /// @param rest  height of the first upper pad on the undeformed disc, m
  Recorder(const RecordingPlan& plan, double rest);

  void add(const Sample& sample);
  /// Completes pending data after the last sample.
  void finish();
  /// Whether sample i belongs to the tail.
  bool in_tail(std::int64_t i) const { return i >= plan_.n_steps - plan_.n_tail; }

  /// The recorded data. `finished`, `speed` and `tail_a` are left to the caller.
  const Transient& transient() const { return transient_; }

 private:
  void add_extremes(double t, const PadState<double>& pad);
  void add_to_window(const Sample& sample);
  void end_window();
  void close_window();
  void keep(const Eigen::VectorXd& sample);

  RecordingPlan plan_;
  double rest_;
  std::optional<double> begin_;  ///< time of the first sample, s
  Transient transient_{};
  Decimator history_;
  std::int64_t n_in_window_ = 0;
  std::int64_t n_open_ = 0;  ///< samples without contact in the window
  PeakFinder velocity_;
  PeakFinder displacement_;
};

/// Records all displacements of the tail of a transient of an axisymmetric disc, in the inertial
/// frame.
class TailRecorder {
 public:
  /// @param inertial, run  must outlive the recorder
  TailRecorder(const Disc& disc, const std::optional<InertialDisc>& inertial,
               const RecordingPlan& plan, const TransientCase& run);

  /// Records sample i at time t (s), which is the present state of the steps.
  void add(std::int64_t i, double t, const ModalSteps& steps);

  /// The displacements for Transient::tail_a.
  Eigen::MatrixXd tail_a() const { return tail_a_.leftCols(n_tail_); }

 private:
  const std::optional<InertialDisc>& inertial_;
  RecordingPlan plan_;
  const TransientCase& run_;
  Eigen::MatrixXd tail_a_;  ///< allocated for the whole tail
  Eigen::Index n_tail_ = 0;
};

}  // namespace chladni::squeal
