#pragma once

#include <string>

#include "cli/arguments.hpp"

namespace chladni::cli {

/// What `squeal run` takes.
struct RunArguments {
  SceneArguments scene;
  std::string body_file;              ///< empty for NAME.body.h5 in the output folder
  bool resume = false;                ///< goes on from where a run was interrupted
  double checkpoint_interval = 60.0;  ///< between two states of a transient, s
};

/// Performs the analyses of the scene's [squeal] on a body file, writes NAME.squeal.h5 and prints
/// the summary. From the begin of the first analysis on, NAME.squeal.h5 is that of this run, and
/// says what is missing in it until the end.
/// @throws chladni::Error when the scene has no [squeal], and from reading, analyses and writing.
void run_squeal(const RunArguments& arguments);

}  // namespace chladni::cli
