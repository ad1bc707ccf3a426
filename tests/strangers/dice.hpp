#pragma once

#include <cmath>
#include <cstdint>

namespace chladni::strangers {

/// Mixes all bits of a number into all others (SplitMix64).
inline std::uint64_t mixed(std::uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Its numbers are the same everywhere, unlike those of the distributions of <random>.
class Dice {
 public:
  /// Mixed, or the numbers of one seed would be those of the next, one step on.
  explicit Dice(std::uint64_t seed) : state_(mixed(seed)) {}
  /// In [0, 1).
  double uniform()
  {
    state_ += 0x9E3779B97F4A7C15ULL;
    return static_cast<double>(mixed(state_) >> 11) * 0x1p-53;
  }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Of logarithms.
  double spread(double low, double high) { return low * std::pow(high / low, uniform()); }
  /// first .. last
  int integer(int first, int last)
  {
    return first + static_cast<int>(uniform() * (last - first + 1));
  }
  bool chance(double probability) { return uniform() < probability; }

 private:
  std::uint64_t state_;
};

}  // namespace chladni::strangers
