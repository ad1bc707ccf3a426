#pragma once

#include <string>
#include <string_view>

#include "brake_fmu/driven_disc.hpp"

namespace chladni::brake_fmu {

/// The name of a brake among the resources of its FMU.
inline constexpr auto brake_file = "brake.chladni-fmu";

/// A brake as bytes, numbers in the order of this machine: all that its motion depends on, and no
/// figures of its modes.
std::string packed(const BrakeModel& model);

/// @throws chladni::Error when the bytes are no such brake, not all of it, or its parts do not fit
///         together.
BrakeModel unpacked_brake(std::string_view bytes);

}  // namespace chladni::brake_fmu
