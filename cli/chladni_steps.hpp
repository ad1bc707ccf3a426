#pragma once

#include <filesystem>
#include <vector>

#include "cli/chladni_commands.hpp"
#include "cli/cost.hpp"
#include "cli/reduce_scene.hpp"
#include "mbs_export/modal_body.hpp"

/// The steps that the subcommands of `chladni` share.
namespace chladni::cli {

std::filesystem::path reduced_file(const Scene& scene, const SceneArguments& arguments);
std::filesystem::path body_file(const Scene& scene, const SceneArguments& arguments);

/// The reduction, with a line of progress on the first rank. @note Collective.
ReduceSummary reduce_with_progress(const Scene& scene, const ChladniArguments& arguments);

/// The body of the scene.
/// @throws chladni::Error when the scene wants to hear a squeal but its supports leave the body
///         free, and as mbs_export::make_body.
mbs_export::ModalBody make_body_of(const Scene& scene, const mbs_export::ReducedSystem& reduced);

/// CPU times summed over the ranks, wall times of the slowest. @note Collective.
Cost cost_of_all_ranks(const std::vector<PhaseTime>& phases);
PhaseTime time_of_all_ranks(const PhaseTime& time);

/// What the reduction was about, beside what the factorisation cost.
TextTable reduction_table(const ReduceSummary& summary);

/// Members `n_dofs`, `n_nodes`, `n_masters`, `n_modes`, `certified_frequencies_Hz` with their
/// `eta2`, `factor_wall_s`, `factor_cpu_s`.
std::vector<Json::Member> reduction_json(const ReduceSummary& summary);

/// Numbers as a JSON array.
Json numbers_json(const Eigen::VectorXd& values);

/// Angular frequencies in rad/s as a JSON array in Hz.
Json frequencies_json(const Eigen::VectorXd& omega);

/// Writes the summary of a subcommand where --json says.
void write_summary(const SceneArguments& arguments, const std::vector<Json::Member>& members,
                   const Cost& cost);

}  // namespace chladni::cli
