#pragma once

#include <memory>
#include <span>

#include "mbs_export/modal_body.hpp"
#include "squeal/model_options.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// The brake of a scene whose model has no mesh.
/// @param bodies  bodies of the parts of an assembly, in their order
/// @throws chladni::Error as `assembly`.
std::unique_ptr<Brake> model_brake(const ModelOptions& options,
                                   std::span<const mbs_export::ModalBody> bodies = {});

}  // namespace chladni::squeal
