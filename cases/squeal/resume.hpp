#pragma once

#include <filesystem>

#include "squeal/results/results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/transient/checkpoint.hpp"

/// Going on with what was interrupted.
namespace chladni::cases {

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

/// The sweep that a file holds, if it is the one that is asked for.
/// @param wanted  with all variants to do
/// @throws chladni::Error when there is no such file or it cannot be gone on with, with the reason.
squeal::SweepTable resume(const std::filesystem::path& sweep_file, const squeal::SweepTable& wanted,
                          const squeal::RunOrigin& origin);

/// @throws chladni::Error when the file holds a sweep that was interrupted: beginning anew would
///         lose it.
void require_no_unfinished_sweep(const std::filesystem::path& sweep_file);

}  // namespace chladni::cases
