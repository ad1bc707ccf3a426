#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "report/origin.hpp"
#include "scene/scene.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/checkpoint.hpp"

/// From a scene and its body to a brake and its study, without PETSc.
namespace chladni::cases {

/// The files of a squeal run.
struct SquealFiles {
  std::filesystem::path folder;
  std::filesystem::path body, radiation;    ///< read
  std::filesystem::path results, sound;     ///< written
  std::filesystem::path checkpoint, spool;  ///< written while the run lasts
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

}  // namespace chladni::cases
