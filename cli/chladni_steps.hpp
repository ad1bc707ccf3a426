#pragma once

#include <filesystem>
#include <vector>

#include "cases/reduce_scene.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/reserve_outputs.hpp"
#include "mbs_export/modal_body.hpp"
#include "report/progress.hpp"
#include "scene/scene.hpp"

/// The steps that the subcommands of `chladni` share.
namespace chladni::cli {

/// What the command line says of a mesh, and no scene can: whether its file may run programs, where
/// meshes are kept.
void apply_mesh_arguments(const ChladniArguments& arguments, mesh::MeshOptions& options);

/// Reads the scene of the arguments, with `apply_mesh_arguments`. Prints the scene's notes.
/// @throws chladni::Error as scene::read_meshed_scene.
scene::Scene read_scene_to_mesh(const ChladniArguments& arguments,
                                scene::Purpose purpose = scene::Purpose::everything);

/// NAME.reduced.h5 in the output folder.
std::filesystem::path reduced_file(const scene::Scene& scene, const SceneArguments& arguments);
/// NAME.body.h5 in the output folder.
std::filesystem::path body_file(const scene::Scene& scene, const SceneArguments& arguments);

/// Reads the reduced system (or the body) from the output folder.
/// @throws chladni::Error naming the file and the command that makes it, when it is missing or,
///         unless the arguments accept stale files, was made before the scene changed.
mbs_export::ReducedSystem read_reduced_of(const scene::Scene& scene,
                                          const SceneArguments& arguments);
mbs_export::ModalBody read_body_of(const scene::Scene& scene, const SceneArguments& arguments);

/// Calls reserve_outputs on the first rank.
/// @note Collective.
ReservedOutputs reserve_on_first_rank(const SceneArguments& arguments,
                                      const std::vector<std::filesystem::path>& files);

/// A function that shows the progress on the terminal of the first rank; the line is wiped when the
/// last copy of the function is destroyed.
/// @param stages  phases in order, with their shares of the time
cases::ReduceProgress progress_bar(std::vector<report::Stage> stages);

/// Solver options from the environment variable PETSC_OPTIONS and from the words after `--`.
cases::SaidOfSolvers said_of_solvers(const ChladniArguments& arguments);

/// A progress line for the reduction of the scene on the first rank, shown until it is destroyed.
cases::ReduceProgress line_of_progress(const scene::Scene& scene);

/// Makes the body of the scene and prints notes about it.
/// @throws chladni::Error when the scene has a squeal study but its supports leave the body free;
///         also as mbs_export::make_body.
mbs_export::ModalBody make_body_of(const scene::Scene& scene,
                                   const mbs_export::ReducedSystem& reduced);

/// Cost over all ranks: CPU times are summed, wall times and peak memory are the maximum.
/// @note Collective.
report::Cost cost_of_all_ranks(const std::vector<report::PhaseTime>& phases);
/// Time of one phase over all ranks: CPU time is summed, wall time is the maximum.
/// @note Collective.
report::PhaseTime time_of_all_ranks(const report::PhaseTime& time);

/// Writes the JSON summary of a subcommand to the file of --json, if one was given.
void write_summary(const SceneArguments& arguments,
                   const std::vector<report::Json::Member>& members, const report::Cost& cost);

}  // namespace chladni::cli
