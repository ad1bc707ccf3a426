#pragma once

#include <array>
#include <string_view>

namespace chladni::squeal {

/// An analysis as a scene asks for it. What performs it is the row of its name in
/// study/analysis_steps.hpp.
struct Analysis {
  std::string_view name;
  std::string_view key;        ///< of [squeal] without which it cannot be done; empty: none
  std::string_view otherwise;  ///< key that holds the same and will do; empty: none
  bool needs_body;             ///< only a flexible disc has it
};

/// All analyses, in the order in which messages and documents list them.
inline constexpr std::array<Analysis, 16> analyses{{
    {"eigenvalues", "speeds", "", false},
    {"critical-speed", "speeds", "", false},
    {"stability", "speeds", "", false},
    {"growth", "growth", "", false},
    {"transient", "transient", "", false},
    {"limit-cycle", "transient", "", false},
    {"motion-statistics", "transient", "", false},
    {"limit-cycle-direct", "limit_cycle_direct", "transient", false},
    {"limit-cycle-branch", "speeds", "", false},
    {"stability-map", "map", "", false},
    {"critical-values", "critical", "", false},
    {"spectrum", "transient", "", true},
    {"spectrogram", "transient", "", true},
    {"mode-sensitivity", "speeds", "", true},
    {"rotation-stability", "speeds", "", true},
    {"gradients", "speeds", "", false},
}};

/// The analysis of this name; null when there is none.
constexpr const Analysis* find_analysis(std::string_view name)
{
  for (const Analysis& analysis : analyses)
    if (analysis.name == name) return &analysis;
  return nullptr;
}

}  // namespace chladni::squeal
