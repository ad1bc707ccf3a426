#pragma once

#include <cstring>

namespace chladni::linear {

/// Numbers in a cache line.
inline constexpr int line_numbers = 8;

/// A cache line of numbers, on which the compiler works with the widest instructions there are.
using Line = double __attribute__((vector_size(line_numbers * sizeof(double))));

[[gnu::always_inline]] inline void load(const double* from, Line& values)
{
  std::memcpy(&values, from, sizeof(values));
}

[[gnu::always_inline]] inline void store(const Line& values, double* to)
{
  std::memcpy(to, &values, sizeof(values));
}

}  // namespace chladni::linear
