#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace chladni::scene {

/// The numbers that a key accepts; never infinite or NaN.
struct Admissible {
  double above = -std::numeric_limits<double>::infinity();     ///< exclusive
  double at_least = -std::numeric_limits<double>::infinity();  ///< inclusive
  double below = std::numeric_limits<double>::infinity();      ///< exclusive
  double at_most = std::numeric_limits<double>::infinity();    ///< inclusive
  std::string_view unit = {};                                  ///< for messages
  /// A number outside usual_from to usual_to gets a note, unless it is 1.
  double usual_from = -std::numeric_limits<double>::infinity();
  double usual_to = std::numeric_limits<double>::infinity();
  std::string_view usually = {};  ///< text of that note, such as "a steel has 2.1e11 Pa"
};

/// Whether the number is accepted.
bool admits(const Admissible& admissible, double x);

/// The numbers that both accept. Unit and note are those of `b` if it has them, else those of `a`.
Admissible both(const Admissible& a, const Admissible& b);

/// The requirement as text, `> 0 and <= 5 (m)`, after `kind` if that is not empty.
std::string requirement(const Admissible& admissible, std::string_view kind = {});

}  // namespace chladni::scene
