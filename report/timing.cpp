#include "report/timing.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace chladni::report {
namespace {

const std::chrono::steady_clock::time_point start_of_process = std::chrono::steady_clock::now();

/// Of this process, or of the processes that it started and that have ended.
rusage usage_of(__rusage_who who)
{
  rusage usage{};
  getrusage(who, &usage);
  return usage;
}

double seconds(const timeval& time)
{
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Stopwatch::Stopwatch()
    : wall_start_(std::chrono::steady_clock::now()), cpu_start_s_(process_cpu_s())
{}

double Stopwatch::wall_s() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
}

double Stopwatch::cpu_s() const
{
  return process_cpu_s() - cpu_start_s_;
}

void PhaseClock::end_phase(std::string name)
{
  PhaseTime now{.name = std::move(name), .wall_s = watch_.wall_s(), .cpu_s = watch_.cpu_s()};
  const auto earlier = std::ranges::find(phases_, now.name, &PhaseTime::name);
  if (earlier == phases_.end()) {
    phases_.push_back(std::move(now));
  } else {
    earlier->wall_s += now.wall_s;
    earlier->cpu_s += now.cpu_s;
  }
  watch_ = Stopwatch();
}

double process_wall_s()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_of_process).count();
}

double process_cpu_s()
{
  double sum = 0.0;
  for (const __rusage_who who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    const rusage usage = usage_of(who);
    sum += seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }
  return sum;
}

double peak_MiB()
{
  constexpr double KiB_per_MiB = 1024.0;
  const auto most = std::max(usage_of(RUSAGE_SELF).ru_maxrss, usage_of(RUSAGE_CHILDREN).ru_maxrss);
  return static_cast<double>(most) / KiB_per_MiB;
}

void keep_freed_memory()
{
#ifdef __GLIBC__
  constexpr int MiB = 1 << 20;
  // To set one of the two ends glibc's own adaptation of both.
  mallopt(M_MMAP_THRESHOLD, 32 * MiB);  // the most that glibc takes
  mallopt(M_TRIM_THRESHOLD, 64 * MiB);
#endif
}

}  // namespace chladni::report
