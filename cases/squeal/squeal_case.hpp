#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "report/origin.hpp"
#include "scene/scene.hpp"
#include "squeal/model_options.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study_options.hpp"

/// From a scene and its body to a brake and its study, without PETSc.

namespace chladni::cases {

/// The files of a squeal run.
struct SquealFiles {
  std::filesystem::path folder;
  std::filesystem::path body, radiation;  ///< read
  std::filesystem::path results, sound;   ///< written
};

/// The files of a run in a folder.
/// @param body  empty for NAME.body.h5 in the folder
SquealFiles squeal_files(const scene::Scene& scene, const std::filesystem::path& folder,
                         const std::filesystem::path& body);

/// What to do with files made from an earlier version of the scene. Empty if the user names a body
/// that need not be the scene's.
using StaleChoice = std::optional<report::Stale>;

/// Checks that the scene asks for a squeal study.
/// @throws chladni::Error when it does not.
void require_study(const scene::Scene& scene);

/// The body of the scene; absent if its model needs none.
/// @throws chladni::Error when there is no file, it is damaged, or it is not that of the scene.
std::optional<mbs_export::ModalBody> body_for_squeal(const scene::Scene& scene,
                                                     const SquealFiles& files, StaleChoice stale);

/// A brake, and notes for the user about it.
struct SquealCase {
  std::unique_ptr<squeal::Brake> brake;
  std::vector<std::string> notes;
};

/// The brake of the scene: a flexible disc, damped by the radiation in its file if the scene says
/// so, or a model without a body.
/// @throws chladni::Error when the body does not fit the scene, or the radiation file is not valid.
SquealCase squeal_case(const scene::Scene& scene, const std::optional<mbs_export::ModalBody>& body,
                       const SquealFiles& files, StaleChoice stale);

/// The study that the scene asks for.
const squeal::StudyOptions& study_of(const scene::Scene& scene);

/// The origin of the results of a run.
/// @param scene_file  path of the scene file relative to the folder of the results
squeal::RunOrigin squeal_origin(const scene::Scene& scene,
                                const std::optional<mbs_export::ModalBody>& body,
                                const SquealFiles& files, const std::string& scene_file);

/// The body files of an assembly's parts, in their order, as seen from where the program runs;
/// empty for another model.
std::vector<std::filesystem::path> part_files(const squeal::ModelOptions& model,
                                              const SquealFiles& files);

/// The bodies of an assembly's parts; equal files are read once.
/// @throws chladni::Error when a file is missing or damaged, or was made of another scene than the
///         one that now lies where its own did.
std::vector<mbs_export::ModalBody> part_bodies(const scene::Scene& scene, const SquealFiles& files,
                                               StaleChoice stale);

}  // namespace chladni::cases

/// Continuing interrupted runs.

namespace chladni::cases {

/// The unfinished results of an interrupted run of this origin, in the file where it left them.
/// @throws chladni::Error when there are none, or when they are of another scene, body or version,
///         which the message names.
squeal::SquealResults resume(const std::filesystem::path& results, const squeal::RunOrigin& origin);

/// The sweep in a file, if it is the one that is asked for.
/// @param wanted  the sweep with all variants to do
/// @throws chladni::Error with the reason when there is no such file or it cannot be continued.
squeal::SweepTable resume(const std::filesystem::path& sweep_file, const squeal::SweepTable& wanted,
                          const squeal::RunOrigin& origin);

/// Checks that the file holds no interrupted sweep, which a new start would overwrite.
/// @throws chladni::Error when it does.
void require_no_unfinished_sweep(const std::filesystem::path& sweep_file);

}  // namespace chladni::cases
