#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace chladni::linear {

/// A number whose bits all depend on all bits of z (the finaliser of splitmix64).
inline std::uint64_t mixed(std::uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Of a set of numbers, in any order; 128 bits, so that two sets do not meet by chance.
struct Fingerprint {
  std::uint64_t a = 0, b = 0;
  bool operator==(const Fingerprint&) const = default;

  void add(std::uint64_t number)
  {
    a += mixed(number + 0x9E3779B97F4A7C15ULL);
    b += mixed(number * 0xD1B54A32D192ED03ULL + 1);
  }
};

struct FingerprintHash {
  std::size_t operator()(const Fingerprint& f) const { return f.a ^ (f.b << 1); }
};

template <typename Value>
using ByFingerprint = std::unordered_map<Fingerprint, Value, FingerprintHash>;

}  // namespace chladni::linear
