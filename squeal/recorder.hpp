#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "squeal/contact.hpp"
#include "squeal/results.hpp"

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
  std::int64_t window;  ///< steps for one point of the envelope
  std::int64_t every;   ///< steps for one point of the history
  std::int64_t n_tail;  ///< steps of the tail
};

/// Collects the results of a transient while it runs.
class Recorder {
 public:
  /// @param rest  height of the first upper pad when the disc is flat, m
  Recorder(const RecordingPlan& plan, double rest);

  void add(std::int64_t i, double t, const std::vector<ContactResult<double>>& contacts);
  bool in_tail(std::int64_t i) const { return i >= plan_.n_steps - plan_.n_tail; }

  /// What was collected; `finished`, `speed` and `tail_a` are left to the caller.
  const Transient& transient() const { return transient_; }

 private:
  void add_extremes(double t, const PadState<double>& pad);
  void close_window();

  RecordingPlan plan_;
  double rest_;
  Transient transient_{};
  PeakFinder velocity_;
  PeakFinder displacement_;
};

}  // namespace chladni::squeal
