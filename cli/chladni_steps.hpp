#pragma once

#include <filesystem>
#include <vector>

#include "cases/reduce_scene.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/reserve_outputs.hpp"
#include "mbs_export/modal_body.hpp"
#include "report/cost.hpp"
#include "report/progress.hpp"
#include "scene/scene.hpp"

/// The steps that the subcommands of `chladni` share.
namespace chladni::cli {

/// The scene of the arguments, with their trust in its mesh file.
/// @throws chladni::Error as scene::read_meshed_scene.
scene::Scene read_scene_to_mesh(const ChladniArguments& arguments,
                                scene::Purpose purpose = scene::Purpose::everything);

std::filesystem::path reduced_file(const scene::Scene& scene, const SceneArguments& arguments);
std::filesystem::path body_file(const scene::Scene& scene, const SceneArguments& arguments);

/// The reduced system and the body that the scene's folder holds, as long as they are of the scene
/// as it is, or the arguments take stale files.
/// @throws chladni::Error naming the file and the command that makes it.
mbs_export::ReducedSystem read_reduced_of(const scene::Scene& scene,
                                          const SceneArguments& arguments);
mbs_export::ModalBody read_body_of(const scene::Scene& scene, const SceneArguments& arguments);

/// On the first rank; see reserve_outputs.hpp. @note Collective.
ReservedOutputs reserve_on_first_rank(const SceneArguments& arguments,
                                      const std::vector<std::filesystem::path>& files);

/// Tells on the terminal of the first rank how far the phases are that take these parts of the
/// time; what it shows is wiped out when the last copy of the function goes.
cases::ReduceProgress progress_bar(std::vector<report::Stage> stages);

/// PETSc's options from the environment and behind `--`.
cases::SaidOfSolvers said_of_solvers(const ChladniArguments& arguments);

/// A line on the first rank that tells how far the reduction of a scene is, until it is destroyed.
cases::ReduceProgress line_of_progress(const scene::Scene& scene);

/// The body of the scene.
/// @throws chladni::Error when the scene wants to hear a squeal but its supports leave the body
///         free, and as mbs_export::make_body.
mbs_export::ModalBody make_body_of(const scene::Scene& scene,
                                   const mbs_export::ReducedSystem& reduced);

/// CPU times summed over the ranks, wall times of the slowest. @note Collective.
report::Cost cost_of_all_ranks(const std::vector<report::PhaseTime>& phases);
report::PhaseTime time_of_all_ranks(const report::PhaseTime& time);

/// Writes the summary of a subcommand where --json says.
void write_summary(const SceneArguments& arguments,
                   const std::vector<report::Json::Member>& members, const report::Cost& cost);

}  // namespace chladni::cli
