#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cases/squeal/squeal_case.hpp"
#include "cases/squeal/sweep.hpp"
#include "cases/squeal/sweep_values.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::cases {

/// The request for a sweep.
struct SweepRequest {
  std::string scene;                   ///< path of the scene file
  std::filesystem::path folder, body;  ///< as for `squeal_files`
  SweepValues values;
  /// Empty: those of the scene that yield single numbers.
  std::vector<std::string> analyses;
  StaleChoice stale;
};

/// A sweep with its scene and table.
struct SweepStudy {
  SweepCase sweep;
  squeal::SweepTable table;  ///< with all variants to do
  squeal::RunOrigin origin;
  std::vector<std::string> notes;
};

/// Prepares a sweep.
/// @param scene_file  path of the scene file relative to the folder of the results
/// @throws chladni::Error when the scene, a key or the body is refused, or when no analysis of the
///         scene yields numbers that a sweep keeps.
SweepStudy sweep_study(const SweepRequest& request, const std::string& scene_file);

}  // namespace chladni::cases
