#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"

namespace chladni::cli {

/// Arguments of `squeal run`.
struct RunArguments {
  SceneArguments scene;
  std::string body_file;  ///< empty for NAME.body.h5 in the output folder
  bool resume = false;    ///< keep the analyses that an interrupted run has finished
};

/// Performs the analyses of the scene's [squeal] on a body file, writes NAME.squeal.h5 and prints
/// the summary. The file belongs to this run as soon as the first analysis starts; until the end it
/// records which results are missing.
/// @throws chladni::Error when the scene has no [squeal], and from reading, analyses and writing.
void run_squeal(const RunArguments& arguments);

}  // namespace chladni::cli

namespace CLI {

class App;

}  // namespace CLI

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

namespace CLI {

class App;

}  // namespace CLI

namespace chladni::cli {

/// What `squeal condense` takes.
struct CondenseArguments {
  SceneArguments scene;
  double tolerance = 1e-3;  ///< largest relative error of an eigenvalue
  double up_to_Hz = 0.0;    ///< end of the band
};

void declare_condense(CLI::App& app, CondenseArguments& arguments);

/// Writes NAME.condensed/PART.body.h5 for each part of the assembly of a scene, with as few
/// coordinates as keep the eigenvalues of the brake, and prints how many these are.
/// @throws chladni::Error when the scene has no assembly, and from reading, condensing and writing.
void run_condense(const CondenseArguments& arguments);

}  // namespace chladni::cli
