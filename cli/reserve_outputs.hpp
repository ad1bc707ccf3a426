#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "cli/arguments.hpp"
#include "files/output_lock.hpp"
#include "report/origin.hpp"

namespace chladni::cli {

/// The right to write some files, as long as it lives.
using ReservedOutputs = std::vector<std::shared_ptr<const files::OutputLock>>;

/// Whether the user takes files that were made before the scene changed.
inline report::Stale stale_of(const SceneArguments& arguments)
{
  return arguments.stale ? report::Stale::use : report::Stale::refuse;
}

/// The scene's file as seen from the output folder, for `Provenance::scene_file`.
std::string scene_file_of(const SceneArguments& arguments);

/// Tells numbers of the scene that look like those of another unit, on stderr.
void tell_notes(const scene::Scene& scene);

/// Makes the output folder if need be, and locks `files` and the summary. To be called before the
/// costly work: what cannot be written, or is being written by another run, is an error at once.
/// @throws chladni::Error naming the file; also where it is of another scene that is still there
///         and has the same name, unless it may be overwritten.
ReservedOutputs reserve_outputs(const SceneArguments& arguments,
                                const std::vector<std::filesystem::path>& files);

}  // namespace chladni::cli
