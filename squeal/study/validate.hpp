#pragma once

#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Checks that the options make sense, each value on its own and all for the analyses asked for.
/// @throws chladni::Error that names the key of the scene, the value and what is allowed.
void validate(const SquealOptions& options);

}  // namespace chladni::squeal
