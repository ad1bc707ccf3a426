#pragma once

#include <string>
#include <utility>

namespace chladni::reduce {

/// Hears of the phases of a reduction, one after the other, on each rank.
class PhaseListener {
 public:
  PhaseListener() = default;
  virtual ~PhaseListener() = default;
  PhaseListener(const PhaseListener&) = delete;
  PhaseListener& operator=(const PhaseListener&) = delete;

  /// What follows is a phase of this name; the phase before it ends here.
  void begin(const std::string& phase)
  {
    end();
    begun(phase);
    is_under_way_ = true;
  }
  /// The last phase ends. A phase that an exception leaves does not end.
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
