#include "linear/kernels/lanes.hpp"

#include <algorithm>
#include <bit>

namespace chladni::linear {

namespace {

int numbers_of_processor()
{
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f")) return 8;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 4;
#endif
  return 2;
}

int& most_numbers()
{
  static int most = numbers_of_processor();
  return most;
}

}  // namespace

int numbers_in_lane()
{
  return most_numbers();
}

int limit_lanes(int most)
{
  most_numbers() =
      std::clamp(static_cast<int>(std::bit_floor(unsigned(most))), 2, numbers_of_processor());
  return most_numbers();
}

}  // namespace chladni::linear
