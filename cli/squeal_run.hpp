#pragma once

#include <string>

#include "cli/arguments.hpp"

namespace chladni::cli {

/// Arguments of `squeal run`.
struct RunArguments {
  SceneArguments scene;
  std::string body_file;              ///< empty for NAME.body.h5 in the output folder
  bool resume = false;                ///< continue an interrupted run
  double checkpoint_interval = 60.0;  ///< time between two checkpoints of a transient, s
};

/// Performs the analyses of the scene's [squeal] on a body file, writes NAME.squeal.h5 and prints
/// the summary. The file belongs to this run as soon as the first analysis starts; until the end it
/// records which results are missing.
/// @throws chladni::Error when the scene has no [squeal], and from reading, analyses and writing.
void run_squeal(const RunArguments& arguments);

}  // namespace chladni::cli
