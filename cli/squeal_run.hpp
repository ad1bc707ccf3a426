#pragma once

#include <string>

#include "cli/arguments.hpp"

namespace chladni::cli {

/// Performs the analyses of the scene's [squeal] on a body file, writes NAME.squeal.h5 and prints
/// the summary.
/// @param body_file  empty for NAME.body.h5 in the output folder
/// @throws chladni::Error when the scene has no [squeal], and from reading, analyses and writing.
void run_squeal(const SceneArguments& arguments, const std::string& body_file);

}  // namespace chladni::cli
