#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cases/squeal/squeal_case.hpp"
#include "cases/squeal/sweep.hpp"
#include "cases/squeal/sweep_values.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::cases {

/// What is asked of a sweep.
struct SweepRequest {
  std::string scene;                   ///< its file
  std::filesystem::path folder, body;  ///< as for squeal_files()
  SweepValues values;
  std::vector<std::string> analyses;  ///< empty: those of the scene that yield single numbers
  StaleChoice stale;
};

/// The scene, what varies in it, and what the variants share.
struct SweepStudy {
  SweepCase sweep;
  squeal::SweepTable table;  ///< all variants to do
  squeal::RunOrigin origin;
  std::vector<std::string> notes;
};

/// @param scene_file  the scene's, as seen from the folder of the results
/// @throws chladni::Error when the scene, a key or the body is refused, or when no analysis of the
///         scene yields numbers that a sweep keeps.
SweepStudy sweep_study(const SweepRequest& request, const std::string& scene_file);

}  // namespace chladni::cases
