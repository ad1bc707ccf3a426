#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "linear/progress.hpp"
#include "reduce/phases.hpp"
#include "report/timing.hpp"

namespace chladni::cases {

/// A function that receives the name of the current phase and how much of it is done, 0 to 1.
using ReduceProgress = std::function<void(const std::string& phase, double fraction)>;

/// Measures the phases of a program on this rank and reports their progress.
class Phases : public reduce::PhaseListener {
 public:
  explicit Phases(const ReduceProgress& progress) : progress_(progress) {}

  /// Tells the progress of this phase under the name of a step of it, until the next one.
  void show_step(const std::string& step);
  const std::vector<report::PhaseTime>& times() const { return clock_.phases(); }
  /// The time of the last phase of this name.
  const report::PhaseTime& time_of(const std::string& name) const;

 private:
  void begun(const std::string& name) override;
  void ended() override;

  const ReduceProgress& progress_;
  std::string name_, shown_;
  std::optional<linear::ListenToProgress> listener_;
  report::PhaseClock clock_;
};

}  // namespace chladni::cases
