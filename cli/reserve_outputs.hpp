#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "cli/arguments.hpp"
#include "files/output_lock.hpp"

namespace chladni::cli {

/// The right to write some files, as long as it lives.
using ReservedOutputs = std::vector<std::shared_ptr<const files::OutputLock>>;

/// Makes the output folder if need be, and locks `files` and the summary. To be called before the
/// costly work: what cannot be written, or is being written by another run, is an error at once.
/// @throws chladni::Error naming the file.
ReservedOutputs reserve_outputs(const SceneArguments& arguments,
                                const std::vector<std::filesystem::path>& files);

}  // namespace chladni::cli
