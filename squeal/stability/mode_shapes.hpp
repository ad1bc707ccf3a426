#pragma once

#include <vector>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Complex shapes of the eigenvalues `map.lambda` of the sliding disc; see EigenvalueMap::shapes.
std::vector<Eigen::MatrixXcd> mode_shapes(const InertialDisc& disc, const SquealOptions& options,
                                          const EigenvalueMap& map);

}  // namespace chladni::squeal
