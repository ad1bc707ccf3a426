#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace chladni::report {

/// What one phase of a program cost.
struct PhaseTime {
  std::string name;
  double wall_s;
  double cpu_s;  ///< of all threads of this process
};

/// Measures from its construction.
class Stopwatch {
 public:
  Stopwatch();
  double wall_s() const;
  double cpu_s() const;

 private:
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_s_;
};

/// Splits the time of a program into phases that follow each other.
class PhaseClock {
 public:
  /// Names what happened since the last call, or since the beginning.
  void end_phase(std::string name);
  const std::vector<PhaseTime>& phases() const { return phases_; }

 private:
  Stopwatch watch_;
  std::vector<PhaseTime> phases_;
};

/// Time since this process began, s.
double process_wall_s();

/// CPU time of this process and its threads since it began, s.
double process_cpu_s();

/// Largest memory that this process has occupied so far, MiB.
double peak_MiB();

}  // namespace chladni::report
