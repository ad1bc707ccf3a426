#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/json.hpp"
#include "report/text_table.hpp"
#include "report/timing.hpp"

namespace chladni::report {

/// How often a phase is performed: once, or an unknown number of times, as in an adaptive loop.
enum class Times { once, unknown };

/// A phase of a run and its usual share of the time, in any unit.
struct Stage {
  std::string name;
  double share;
  Times times = Times::once;
};

/// The fraction done of a whole run, which never decreases. A phase with an unknown number of
/// repetitions takes half of the rest of its share each time. A phase that is not among the stages
/// takes no share.
class WholeProgress {
 public:
  /// @param stages  in order; skipped stages count as done when a later one begins
  explicit WholeProgress(std::vector<Stage> stages);

  /// The progress of the whole run.
  /// @param fraction  fraction done of the phase, 0 to 1
  /// @return fraction done of the run, 0 to 1
  double at(const std::string& phase, double fraction);

 private:
  void enter(const std::string& phase);

  std::vector<Stage> stages_;
  std::optional<std::size_t> stage_;  ///< the current stage
  std::string phase_;                 ///< the current phase, which need not be a stage
  double left_ = 1.0;                 ///< fraction of the stage left for this and later repetitions
  double done_ = 0.0;
};

/// A progress line: "[########------------]  42 %  projection, 7 s left"; without a time in the
/// first two seconds.
std::string progress_text(std::string_view phase, double whole, double elapsed_s);

/// Suppresses results and progress from now on; only notes and errors are still printed.
void be_quiet();

/// Prints "note: ..." on stderr. On a terminal it replaces a progress line.
void tell_note(std::string_view note);

/// What a log is told of the progress: a line of its own after ten seconds, and then ever more
/// rarely, as often as the time has doubled, but each minute.
class ProgressLog {
 public:
  /// @param whole      fraction done of the whole run, 0 to 1
  /// @param elapsed_s  since the run began
  /// @return absent while it is not yet time for a line
  std::optional<std::string> line(std::string_view phase, double whole, double elapsed_s);

 private:
  double next_s_ = 10.0;
};

/// The progress of a run on stderr: on a terminal a line that is drawn anew and wiped by the
/// destructor, elsewhere the lines of a log. Nothing after be_quiet.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows the progress, on a terminal at most every 0.2 s within a phase.
  /// @param whole  fraction done of the whole run, 0 to 1
  void show(const std::string& phase, double whole);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(const std::string& phase, double whole, Clock::time_point now);
  void wipe();

  ProgressLog log_;
  std::string phase_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_;
  bool visible_ = false;
};

}  // namespace chladni::report

/// Cost of a program for its summaries.

namespace chladni::report {

/// Time and memory of a whole program run.
struct Cost {
  std::vector<PhaseTime> phases;
  double wall_s;    ///< wall time of the slowest rank since the process started, s
  double cpu_s;     ///< CPU time of all ranks since the process started, s
  double peak_MiB;  ///< peak memory of the rank that needed most
};

/// The given phases with the times and the peak memory of this process up to now.
Cost cost_so_far(std::vector<PhaseTime> phases);

/// The cost as a table for the terminal.
TextTable cost_table(const Cost& cost);

/// Members `phases` (name -> wall_s), `phases_cpu_s`, `wall_s`, `cpu_s`, `peak_MiB`.
std::vector<Json::Member> cost_json(const Cost& cost);

}  // namespace chladni::report
