#pragma once

#include <vector>

#include "linear/dense/decoupled_coordinates.hpp"
#include "linear/dense/eigenmodes.hpp"

namespace chladni::linear {

/// Modes of coordinates that are coupled to no others.
struct PartModes {
  std::vector<Eigen::Index> coordinates;
  Eigenmodes modes;  ///< in these coordinates
};

/// The modes of all parts in n coordinates.
Eigenmodes merged(const std::vector<PartModes>& parts, Eigen::Index n);

}  // namespace chladni::linear
