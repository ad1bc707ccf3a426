#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"

/// The subcommands of the program `chladni`. Each prints its summary on the first rank, writes the
/// files at its end, and throws chladni::Error when the job failed, before anything is written.
/// @note Collective on all ranks.
namespace chladni::cli {

struct ChladniArguments {
  SceneArguments scene;
  std::string info_file;
  std::vector<std::string> petsc_options;  ///< what stands after `--`
};

/// Meshes the scene and says what the mesh is like.
void mesh_command(const ChladniArguments& arguments);

/// Meshes, assembles and reduces; writes NAME.reduced.h5.
void reduce_command(const ChladniArguments& arguments);

/// Makes the modal body of NAME.reduced.h5; writes NAME.body.h5. Needs no PETSc.
void body_command(const ChladniArguments& arguments);

/// All of this, from the scene to both files.
void run_command(const ChladniArguments& arguments);

/// Says what a file of Chladni holds.
void info_command(const ChladniArguments& arguments);

}  // namespace chladni::cli
