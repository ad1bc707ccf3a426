#pragma once

#include <array>
#include <string_view>

namespace chladni::squeal {

/// An analysis that a scene can ask for. Its implementation is the row with the same name in
/// study/analysis_steps.hpp.
struct Analysis {
  std::string_view name;
  std::string_view key;        ///< key of [squeal] that the analysis needs; empty: none
  std::string_view otherwise;  ///< key that may replace it; empty: none
  bool needs_body;             ///< needs a flexible disc
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

/// The analysis with this name; null for an unknown name.
constexpr const Analysis* find_analysis(std::string_view name)
{
  for (const Analysis& analysis : analyses)
    if (analysis.name == name) return &analysis;
  return nullptr;
}

}  // namespace chladni::squeal
