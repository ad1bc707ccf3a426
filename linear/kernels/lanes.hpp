#pragma once

#include <cstring>

namespace chladni::linear {

/// As many numbers side by side as the instructions of a processor take at once: GCC moves the
/// numbers of a wider vector one by one, by way of the stack.
template <int numbers>
struct Lane;
template <>
struct Lane<2> {
  double __attribute__((vector_size(16))) values;
};
template <>
struct Lane<4> {
  double __attribute__((vector_size(32))) values;
};
template <>
struct Lane<8> {
  double __attribute__((vector_size(64))) values;
};

template <int numbers>
[[gnu::always_inline]] inline void load(const double* from, Lane<numbers>& lane)
{
  std::memcpy(&lane.values, from, sizeof(lane.values));
}

template <int numbers>
[[gnu::always_inline]] inline void store(const Lane<numbers>& lane, double* to)
{
  std::memcpy(to, &lane.values, sizeof(lane.values));
}

#ifdef __x86_64__

template <typename Work>
[[gnu::target("avx512f"), gnu::flatten]] void on_lanes_of_8(const Work& work)
{
  work.template operator()<8>();
}

template <typename Work>
[[gnu::target("avx2,fma"), gnu::flatten]] void on_lanes_of_4(const Work& work)
{
  work.template operator()<4>();
}

#endif

template <typename Work>
[[gnu::flatten]] void on_lanes_of_2(const Work& work)
{
  work.template operator()<2>();
}

/// Numbers in the widest lane of the processor at hand: 8, 4, or the 2 of Debian's baseline.
int numbers_in_lane();

/// Lets narrower lanes be taken, to try what other processors do.
/// @return those that are taken from now on
int limit_lanes(int most);

/// Calls work.operator()<numbers>(), compiled for the processor at hand, with that many numbers in
/// its widest lane.
template <typename Work>
void on_widest_lanes(const Work& work)
{
#ifdef __x86_64__
  if (numbers_in_lane() == 8) return on_lanes_of_8(work);
  if (numbers_in_lane() == 4) return on_lanes_of_4(work);
#endif
  on_lanes_of_2(work);
}

}  // namespace chladni::linear
