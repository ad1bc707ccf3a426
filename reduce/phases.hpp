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
  virtual void begin(const std::string& /*phase*/) {}
  /// Not after a phase that an exception has ended.
  virtual void end() {}
};

/// What work() returns, as a phase of its own.
template <typename Work>
auto in_phase(PhaseListener& listener, const std::string& name, const Work& work)
{
  listener.begin(name);
  auto result = work();
  listener.end();
  return result;
}

}  // namespace chladni::reduce
