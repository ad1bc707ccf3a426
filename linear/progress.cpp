#include "linear/progress.hpp"

#include <utility>

namespace chladni::linear {

namespace {

ProgressListener& current()
{
  static ProgressListener listener;
  return listener;
}

}  // namespace

ListenToProgress::ListenToProgress(ProgressListener listener)
    : before_(std::exchange(current(), std::move(listener)))
{}

ListenToProgress::~ListenToProgress()
{
  current() = std::move(before_);
}

void report_progress(double fraction)
{
  if (current()) current()(fraction);
}

}  // namespace chladni::linear
