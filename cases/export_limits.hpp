#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs_export/formats/export_error.hpp"
#include "mbs_export/modal_body.hpp"
#include "scene/scene.hpp"

/// Messages of `chladni export` about parts of a scene that the other program's format cannot hold.
namespace chladni::cases {

/// Refuses an export and names the place in the scene that asks for what the format cannot hold;
/// for springs and dampers those to the ground.
/// @throws chladni::Error naming file, line and key.
[[noreturn]] void refuse_export(const scene::Scene& scene,
                                const mbs_export::formats::ExportError& error);

/// Refuses a body that `squeal condense` made: it has no motions but those of one brake.
/// @param file  the body's
/// @throws chladni::Error naming the file and the brake.
void refuse_condensed(const mbs_export::ModalBody& body, const std::string& file);

/// The damping of [body] that a file of this format lacks, one sentence for each part.
/// @param n_free_rigid  number of rigid motions that the supports leave to the body
std::vector<std::string> damping_left_out(const std::string& format,
                                          const mbs_export::Damping& damping, int n_free_rigid);

/// The notes, with those added about geometric stiffening that a file of this format lacks, because
/// it has no place for it or because the stress belongs to another support.
/// @param there    stiffening of the reduced system or the body from which the file is made
/// @param written  stiffening of the body that goes into the file; empty for a reduced system
std::vector<std::string> with_stiffening_left_out(
    std::vector<std::string> notes, const std::string& format,
    const std::optional<mbs_export::Stiffening>& there,
    const std::optional<mbs_export::Stiffening>& written);

}  // namespace chladni::cases
