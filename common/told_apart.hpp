#pragma once

#include <fmt/format.h>

#include <string>

namespace chladni {

/// A value and the limit that it does not keep, as text.
struct ToldApart {
  std::string value, limit;
};

/// Both with as many digits as tell them apart: "the limit is 0.001, and 0.001 was reached" tells
/// nobody anything.
/// @param digits  at least
inline ToldApart told_apart(double value, double limit, int digits = 2)
{
  constexpr int all = 17;
  for (;; ++digits) {
    ToldApart text{fmt::format("{:.{}g}", value, digits), fmt::format("{:.{}g}", limit, digits)};
    if (text.value != text.limit || digits == all) return text;
  }
}

}  // namespace chladni
