#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "linear/machine_memory.hpp"
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

  void begin(const std::string& name) override
  {
    name_ = name;
    if (!progress_) return;
    progress_(name_, 0.0);
    listener_.emplace([this](double fraction) { progress_(name_, fraction); });
  }

  void end() override
  {
    linear::give_back_freed();  // is there for the next one
    listener_.reset();
    clock_.end_phase(name_);
    if (progress_) progress_(name_, 1.0);
  }

  template <typename Work>
  auto run(const std::string& name, const Work& work)
  {
    return reduce::in_phase(*this, name, work);
  }
  const std::vector<report::PhaseTime>& times() const { return clock_.phases(); }
  /// The last phase of this name.
  const report::PhaseTime& time_of(const std::string& name) const;

 private:
  const ReduceProgress& progress_;
  std::string name_;
  std::optional<linear::ListenToProgress> listener_;
  report::PhaseClock clock_;
};

}  // namespace chladni::cases
