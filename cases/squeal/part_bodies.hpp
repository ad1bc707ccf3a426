#pragma once

#include <filesystem>
#include <vector>

#include "cases/squeal/squeal_case.hpp"
#include "mbs_export/modal_body.hpp"
#include "scene/scene.hpp"
#include "squeal/model_options.hpp"

namespace chladni::cases {

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
