#pragma once

#include <string>
#include <vector>

#include "mbs_export/formats/export_error.hpp"
#include "mbs_export/reduced_system.hpp"
#include "scene/scene.hpp"

/// What `chladni export` says of a scene that the other program's format cannot hold.
namespace chladni::cases {

/// Refuses an export with the place in the scene that asks for what the format cannot hold; of
/// springs and dampers those to the ground.
/// @throws chladni::Error naming file, line and key
[[noreturn]] void refuse_export(const scene::Scene& scene,
                                const mbs_export::formats::ExportError& error);

/// The damping of [body] that the file of this format goes without, one sentence for each part.
/// @param n_free_rigid  rigid motions of the body that its supports leave free
std::vector<std::string> damping_left_out(const std::string& format,
                                          const mbs_export::Damping& damping, int n_free_rigid);

}  // namespace chladni::cases
