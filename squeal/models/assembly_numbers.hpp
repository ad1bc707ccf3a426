#pragma once

#include <functional>
#include <string>
#include <vector>

#include "squeal/assembly_options.hpp"

namespace chladni::squeal {

/// A number of the scene of an assembly.
struct AssemblyNumber {
  std::string key;   ///< of the scene: "joint[2].stiffness.z", "part[3].position[1]"
  std::string unit;  ///< of its value
  double value;
  double step;  ///< a change of the value that is small but above rounding; 0: a part of the value
  std::function<void(AssemblyOptions& options, double value)> set;
};

/// Every number of parts, joints, linings and disc on which small motions depend, but for the keys
/// of the brake's own friction law, which are parameters of every brake: places and rotations of
/// parts, stiffness and damping of joints (those that are not zero), height, stiffness, damping,
/// preload and own friction of linings, thickness or contact planes, points of friction tables.
std::vector<AssemblyNumber> assembly_numbers(const AssemblyOptions& options);

}  // namespace chladni::squeal
