#pragma once

#include <functional>

namespace chladni::linear {

/// Takes the share of the step under way that is done, 0 to 1.
using ProgressListener = std::function<void(double fraction)>;

/// While it lives, long steps of the reduction on this rank tell the listener how far they are.
class ListenToProgress {
 public:
  explicit ListenToProgress(ProgressListener listener);
  ~ListenToProgress();
  ListenToProgress(const ListenToProgress&) = delete;
  ListenToProgress& operator=(const ListenToProgress&) = delete;

 private:
  ProgressListener before_;
};

/// Tells the listener, if there is one.
void report_progress(double fraction);

}  // namespace chladni::linear
