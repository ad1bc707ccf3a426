#pragma once

#include <string>
#include <string_view>

#include "brake_fmu/driven_disc.hpp"

namespace chladni::brake_fmu {

/// Name of the brake's file among the resources of its FMU.
inline constexpr auto brake_file = "brake.chladni-fmu";

/// The brake as bytes, with numbers in the byte order of this machine. It contains all that the
/// motion depends on, but not the figures of the modes.
std::string packed(const BrakeModel& model);

/// The brake that `packed` wrote.
/// @throws chladni::Error when the bytes are not a brake, are incomplete, or hold parts that do not
///         fit together.
BrakeModel unpacked_brake(std::string_view bytes);

}  // namespace chladni::brake_fmu
