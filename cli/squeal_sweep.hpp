#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"

namespace CLI {
class App;
}

namespace chladni::cli {

/// Arguments of `squeal sweep`.
struct SweepArguments {
  SceneArguments scene;
  std::string body_file;              ///< empty for NAME.body.h5 in the output folder
  std::vector<std::string> vary;      ///< "KEY=FROM:TO:COUNT" or "KEY=VALUE,VALUE,..."
  std::string samples;                ///< file with the values of every variant; empty for none
  std::vector<std::string> analyses;  ///< empty: those of the scene that yield single numbers
  bool resume = false;                ///< continue an interrupted sweep
  double checkpoint_interval = 10.0;  ///< time between two writes of the table to its file, s
  unsigned n_threads = 0;             ///< number of threads; 0: as many as there are processors
};

/// Declares the subcommand `sweep` of `app`.
void declare_sweep(CLI::App& app, SweepArguments& arguments);

/// Performs the analyses of the scene for each variant, and writes NAME.sweep.h5 and
/// NAME.sweep.csv.
/// @throws chladni::Error before the first variant when a key, a value or an analysis is not
///         allowed; after the last one when all variants have failed.
void run_sweep(const SweepArguments& arguments);

}  // namespace chladni::cli
