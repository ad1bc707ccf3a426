#pragma once

#include <filesystem>

#include "squeal/results/results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/transient/checkpoint.hpp"

/// Continuing interrupted runs.
namespace chladni::cases {

/// The files in which an interrupted run left its results and its state.
struct LeftBehind {
  std::filesystem::path results, checkpoint;
};

/// The unfinished results of an interrupted run of this origin. Reads the checkpoint as well.
/// @return results; empty if there are none yet
/// @throws chladni::Error when nothing was left, or when it is of another scene, body or version,
///         which the message names.
squeal::SquealResults resume(const LeftBehind& left, const squeal::RunOrigin& origin,
                             squeal::Checkpoint& checkpoint);

/// The sweep in a file, if it is the one that is asked for.
/// @param wanted  the sweep with all variants to do
/// @throws chladni::Error with the reason when there is no such file or it cannot be continued.
squeal::SweepTable resume(const std::filesystem::path& sweep_file, const squeal::SweepTable& wanted,
                          const squeal::RunOrigin& origin);

/// Checks that the file holds no interrupted sweep, which a new start would overwrite.
/// @throws chladni::Error when it does.
void require_no_unfinished_sweep(const std::filesystem::path& sweep_file);

}  // namespace chladni::cases
