#pragma once

#include <filesystem>

#include "scene/scene.hpp"
#include "squeal/results/results.hpp"
#include "squeal/transient/checkpoint.hpp"

namespace chladni::cli {

/// Where a run that was interrupted left its results and its state.
struct LeftBehind {
  std::filesystem::path results, checkpoint;
};

/// What is there of an interrupted run of this origin; the checkpoint is read.
/// @return its unfinished results; nothing is missing in them where there are none
/// @throws chladni::Error when nothing was left behind, or when it is of another scene, body or
///         version, which it names.
squeal::SquealResults resume(const LeftBehind& left, const squeal::RunOrigin& origin,
                             squeal::Checkpoint& checkpoint);

}  // namespace chladni::cli
