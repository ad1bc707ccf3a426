#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/friction.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// The points of the table of a friction law, as `friction_points`.
/// @param key    of the law in the scene: "friction", "pads[2].friction"
/// @param brake  the brake with another law in place of this one
std::vector<BrakeNumber> friction_point_numbers(
    const FrictionLaw& law, const std::string& key,
    const std::function<std::unique_ptr<Brake>(FrictionLaw)>& brake);

/// The frequency (Hz) of each mode or pair of modes of a disc. With another frequency a mode keeps
/// its damping in 1/s.
/// @param disc   must live as long as the numbers
/// @param brake  the brake with another disc in place of this one
std::vector<BrakeNumber> disc_frequencies(
    const InertialDisc& disc, const std::function<std::unique_ptr<Brake>(InertialDisc)>& brake);

}  // namespace chladni::squeal
