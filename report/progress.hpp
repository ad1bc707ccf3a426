#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chladni::report {

/// How often a phase is done: until something is accurate, nobody knows before.
enum class Times { once, unknown };

/// A phase of a run, and what part of the time it usually takes, in any unit.
struct Stage {
  std::string name;
  double share;
  Times times = Times::once;
};

/// How much of a whole run is done, which never falls. A phase that is done an unknown number of
/// times takes half of what is left of its share each time; one that the stages do not name takes
/// none.
class WholeProgress {
 public:
  /// @param stages  in their order; those that a run leaves out are over when a later one begins
  explicit WholeProgress(std::vector<Stage> stages);

  /// @param fraction  of the phase, 0 to 1
  /// @return of the run, 0 to 1
  double at(const std::string& phase, double fraction);

 private:
  void enter(const std::string& phase);

  std::vector<Stage> stages_;
  std::optional<std::size_t> stage_;  ///< under way
  std::string phase_;                 ///< under way; not always a stage
  double left_ = 1.0;                 ///< of the stage, for this time and later ones
  double done_ = 0.0;
};

/// "[########------------]  42 %  projection, 7 s left"; no time in the first two seconds.
std::string progress_text(std::string_view phase, double whole, double elapsed_s);

/// Prints no results from here on, and no progress: of what follows only notes and errors are seen.
void be_quiet();

/// Prints "note: ..." on stderr, on a terminal over the progress line if one stands there.
void tell_note(std::string_view note);

/// One line on stderr that tells how far a run is; it shows only where stderr is a terminal and
/// nobody wanted quiet, and is wiped out at the end.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param whole  part of the whole run, 0 to 1
  void show(const std::string& phase, double whole);

 private:
  using Clock = std::chrono::steady_clock;

  void wipe();

  std::string phase_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_;
  bool visible_ = false;
};

}  // namespace chladni::report
