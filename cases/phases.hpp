#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "linear/progress.hpp"
#include "reduce/phases.hpp"
#include "report/timing.hpp"

namespace chladni::cases {

/// Called with the name of the phase under way and the fraction of it that is done, 0 to 1.
using ReduceProgress = std::function<void(const std::string& phase, double fraction)>;

/// The phases of a program on this rank: timed, and their progress told.
class Phases : public reduce::PhaseListener {
 public:
  explicit Phases(const ReduceProgress& progress) : progress_(progress) {}

  const std::vector<report::PhaseTime>& times() const { return clock_.phases(); }
  /// The last phase of this name.
  const report::PhaseTime& time_of(const std::string& name) const;

 private:
  void begun(const std::string& name) override;
  void ended() override;

  const ReduceProgress& progress_;
  std::string name_;
  std::optional<linear::ListenToProgress> listener_;
  report::PhaseClock clock_;
};

}  // namespace chladni::cases
