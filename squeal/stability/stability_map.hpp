#pragma once

#include <functional>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/models/model.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The options with one parameter set to `value`, for every pad if it is one of pads.
SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value);

/// "friction", "preload" or "stiffness", as in the scene.
const char* name_of(MapParameter parameter);

/// The least stable eigenvalues over `options.study.speeds` and `options.study.map`, on `n_threads`
/// threads (0: as many as processors). The result does not depend on their number.
/// @throws chladni::Error when `options.study.map` is absent.
StabilityMap stability_map(const InertialDisc& disc, const SquealOptions& options,
                           unsigned n_threads = 0);

/// The same of whatever has a state matrix for each value of the parameter.
/// @param A_of  yields the state matrix over the speed; called from several threads
StabilityMap stability_map(const std::function<StateMatrixAt(double value)>& A_of,
                           const MapCase& range, const SpeedRange& speeds, unsigned n_threads = 0);

}  // namespace chladni::squeal
