#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "common/files/output_file.hpp"
#include "report/origin.hpp"

namespace chladni::cli {

/// Locks on output files, held as long as this object exists.
using ReservedOutputs = std::vector<std::shared_ptr<const files::OutputLock>>;

/// Whether the user accepts files that were made before the scene changed.
inline report::Stale stale_of(const SceneArguments& arguments)
{
  return arguments.stale ? report::Stale::use : report::Stale::refuse;
}

/// The scene's file relative to the output folder, for `Provenance::scene_file`; empty if unknown.
std::string scene_file_of(const SceneArguments& arguments);

/// Prints the scene's notes on stderr: numbers that look as if they were in another unit.
void tell_notes(const scene::Scene& scene);

/// Makes the output folder if needed, and locks `files` and the JSON summary. Call it before costly
/// work, so that a file that cannot be written, or that another run is writing, is reported at
/// once.
/// @throws chladni::Error naming the file, also when another scene that still exists wrote it under
///         the same name and --overwrite is not given.
ReservedOutputs reserve_outputs(const SceneArguments& arguments,
                                const std::vector<std::filesystem::path>& files);

/// An XML or HTML comment for the end of a file, which names the scene's file relative to the
/// output folder.
std::string writer_mark(const SceneArguments& arguments);

}  // namespace chladni::cli
