#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string_view>

#include "common/error.hpp"

namespace chladni {

/// The largest count that PETSc with 32-bit indices, METIS and a call of MPI can represent.
inline constexpr std::int64_t largest_count = std::numeric_limits<std::int32_t>::max();

/// n as an int.
/// @param what  what is counted, "entries of K on one rank"
/// @param cure  what to do, "use more ranks"
/// @throws chladni::Error when n is larger than `largest_count`.
inline int checked_count(std::int64_t n, std::string_view what, std::string_view cure)
{
  if (n <= largest_count) return static_cast<int>(n);
  throw Error(fmt::format("{} {} are more than the {} that indices of 32 bits count; {}", n, what,
                          largest_count, cure));
}

}  // namespace chladni
