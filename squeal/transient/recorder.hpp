#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/motion/state_archive.hpp"
#include "squeal/results/results.hpp"
#include "squeal/transient/decimator.hpp"

namespace chladni::squeal {

/// The largest |x| of the peaks of a sampled oscillation, each refined by a parabola.
class PeakFinder {
 public:
  /// The next sample, at time `t`; samples are `step` apart (s).
  void add(double t, double x, double step);

  /// The largest peak since the last call; absent when there was none.
  struct Peak {
    double t;
    double value;
  };
  std::optional<Peak> take();

  void exchange(StateArchive& archive);

 private:
  double before_ = 0.0;
  double last_ = 0.0;
  int n_seen_ = 0;
  std::optional<Peak> largest_;
};

/// What to record of a run of `n_steps` steps.
struct RecordingPlan {
  double step;  ///< s
  std::int64_t n_steps;
  std::int64_t window;          ///< steps for one point of the envelope
  std::int64_t n_fine_windows;  ///< points after which there are more steps for each
  std::int64_t late_window;     ///< steps for one of those
  Decimation history;           ///< of the steps
  std::int64_t snapshots;       ///< steps for one snapshot
  std::int64_t n_tail;          ///< steps of the tail
};

/// The motion at a sample.
struct Sample {
  std::int64_t i;                                      ///< from 0
  double t;                                            ///< s
  double speed;                                        ///< of rotation, rad/s
  const std::vector<ContactResult<double>>& contacts;  ///< one for each pad pair
};

/// Collects the results of a transient while it runs.
class Recorder {
 public:
  /// @param rest  height of the first upper pad when the disc is flat, m
  Recorder(const RecordingPlan& plan, double rest);

  void add(const Sample& sample);
  /// After the last sample: completes what waits for more.
  void finish();
  void exchange(StateArchive& archive);
  bool in_tail(std::int64_t i) const { return i >= plan_.n_steps - plan_.n_tail; }

  /// What was collected; `finished`, `speed` and `tail_a` are left to the caller.
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
  std::int64_t n_open_ = 0;  ///< in the window
  PeakFinder velocity_;
  PeakFinder displacement_;
};

}  // namespace chladni::squeal
