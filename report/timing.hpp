#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace chladni::report {

/// Cost of one phase of a program.
struct PhaseTime {
  std::string name;
  double wall_s;
  double cpu_s;  ///< CPU time of all threads of this process
};

/// Measures wall and CPU time since its construction, s.
class Stopwatch {
 public:
  Stopwatch();
  double wall_s() const;
  double cpu_s() const;

 private:
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_s_;
};

/// Divides the time of a program into consecutive phases.
class PhaseClock {
 public:
  /// Ends the current phase, which began at the last call or at construction, and names it.
  void end_phase(std::string name);
  const std::vector<PhaseTime>& phases() const { return phases_; }

 private:
  Stopwatch watch_;
  std::vector<PhaseTime> phases_;
};

/// Wall time since this process started, s.
double process_wall_s();

/// CPU time of all threads of this process since it started, s.
double process_cpu_s();

/// Peak memory of this process so far, MiB.
double peak_MiB();

/// Lets the heap keep up to 64 MiB of what is freed for the next arrays. A loop that makes and
/// frees matrices otherwise gives them back to the machine each time and takes cleared pages again,
/// which can take longer than what is computed in them. For the whole process, at its start.
void keep_freed_memory();

}  // namespace chladni::report
