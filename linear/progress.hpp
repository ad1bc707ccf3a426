#pragma once

#include <functional>

namespace chladni::linear {

/// A function that receives how much of the current step is done, 0 to 1.
using ProgressListener = std::function<void(double fraction)>;

/// During its lifetime, long steps of the reduction on this rank report their progress to the
/// listener.
class ListenToProgress {
 public:
  explicit ListenToProgress(ProgressListener listener);
  ~ListenToProgress();
  ListenToProgress(const ListenToProgress&) = delete;
  ListenToProgress& operator=(const ListenToProgress&) = delete;

 private:
  ProgressListener before_;
};

/// Calls the listener, if there is one.
void report_progress(double fraction);

}  // namespace chladni::linear
