#pragma once

#include <optional>
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

/// Adds to the notes what geometric stiffening the file of this format goes without: no place for
/// it, or another support than that of the stress.
/// @param there    of the reduced system or the body that the file is made of
/// @param written  that of the body that goes into the file; none for a reduced system
std::vector<std::string> with_stiffening_left_out(
    std::vector<std::string> notes, const std::string& format,
    const std::optional<mbs_export::Stiffening>& there,
    const std::optional<mbs_export::Stiffening>& written);

}  // namespace chladni::cases
