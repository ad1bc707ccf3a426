#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// K - sigma M, symmetric and not marked definite.
/// @note   Collective.
petsc::Matrix shifted(Mat K, Mat M, double sigma);

}  // namespace chladni::linear
