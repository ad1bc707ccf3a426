#pragma once

#include <string>
#include <utility>

namespace chladni::reduce {

/// Receives the begin and the end of each phase of a reduction, on each rank. Phases follow one
/// another and are not nested.
class PhaseListener {
 public:
  PhaseListener() = default;
  virtual ~PhaseListener() = default;
  PhaseListener(const PhaseListener&) = delete;
  PhaseListener& operator=(const PhaseListener&) = delete;

  /// Begins a phase of this name and ends the phase before it.
  void begin(const std::string& phase)
  {
    end();
    begun(phase);
    is_under_way_ = true;
  }
  /// Ends the last phase. A phase that an exception leaves is not ended.
  void end()
  {
    if (std::exchange(is_under_way_, false)) ended();
  }

 private:
  virtual void begun(const std::string& /*phase*/) {}
  virtual void ended() {}

  bool is_under_way_ = false;
};

}  // namespace chladni::reduce
