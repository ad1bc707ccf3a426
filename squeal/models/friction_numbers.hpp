#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "squeal/friction.hpp"

namespace chladni::squeal {

/// A number by which a scene gives a friction law.
struct FrictionNumber {
  std::string key;        ///< "friction.static", "pads[2].friction.table[1].mu[3]"
  std::string_view unit;  ///< of its value
  double value;
  double step;  ///< small change of the value for differences; 0: a part of the value
  std::function<FrictionLaw(double value)> with;  ///< the law with another value of this number
};

/// The points of the table of a measured law: the friction coefficient and the sliding speed of
/// each point of each row. Temperatures and pressures of the rows are not among them, because they
/// span a grid of which no row can be moved alone.
/// @param key  of the law in the scene: "friction", "pads[2].friction"
/// @return empty for a law without a table
std::vector<FrictionNumber> friction_points(const FrictionLaw& law, const std::string& key);

/// All numbers by which a scene gives a law: its own keys, then `friction_points`.
std::vector<FrictionNumber> friction_numbers(const FrictionLaw& law, const std::string& key);

}  // namespace chladni::squeal
