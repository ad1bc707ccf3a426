#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace chladni::scene {

/// The numbers that a key admits; never infinite, never NaN.
struct Admissible {
  double above = -std::numeric_limits<double>::infinity();     ///< exclusive
  double at_least = -std::numeric_limits<double>::infinity();  ///< inclusive
  double below = std::numeric_limits<double>::infinity();      ///< exclusive
  double at_most = std::numeric_limits<double>::infinity();    ///< inclusive
  std::string_view unit = {};                                  ///< for messages
  double usual_from = -std::numeric_limits<double>::infinity();
  double usual_to = std::numeric_limits<double>::infinity();
  std::string_view usually = {};  ///< of a number outside the last two: "a steel has 2.1e11 Pa"
};

bool admits(const Admissible& admissible, double x);

/// What both admit, with the unit of `b` where it has one.
Admissible both(const Admissible& a, const Admissible& b);

/// `> 0 and <= 5 (m)`, after `kind` when that is not empty.
std::string requirement(const Admissible& admissible, std::string_view kind = {});

}  // namespace chladni::scene
