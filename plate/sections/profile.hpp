#pragma once

#include <array>

#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The value of a profile at a place of the model, m.
/// @throws chladni::Error when a formula cannot be parsed or has no finite value there.
double value_at(const Profile& profile, const std::array<double, 3>& place);

}  // namespace chladni::plate
