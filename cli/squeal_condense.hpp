#pragma once

#include "cli/arguments.hpp"

namespace CLI {
class App;
}

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
