#pragma once

#include <cstddef>
#include <cstdint>

/// Types of FMI 3.0, laid out as the standard requires.

namespace chladni::fmu::fmi3 {

using Reference = std::uint32_t;

enum Status : int { ok, warning, discard, error, fatal };
enum DependencyKind : int { independent, constant, fixed, tunable, discrete, dependent };
enum IntervalQualifier : int { not_yet_known, unchanged, changed };

using LogMessage = void (*)(void* environment, Status status, const char* category,
                            const char* message);
using IntermediateUpdate = void (*)(void* environment, double time, bool set_requested,
                                    bool get_allowed, bool step_finished, bool can_return_early,
                                    bool* early_return_requested, double* early_return_time);

}  // namespace chladni::fmu::fmi3
