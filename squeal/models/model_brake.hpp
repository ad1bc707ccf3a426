#pragma once

#include <memory>

#include "squeal/model_options.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// The brake without a body that a scene asks for.
std::unique_ptr<Brake> model_brake(const ModelOptions& options);

}  // namespace chladni::squeal
