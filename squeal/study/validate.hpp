#pragma once

#include "squeal/models/brake.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Checks that the options of a study make sense, each value on its own and all for the analyses
/// asked for, and those of a brake with a body likewise.
/// @throws chladni::Error that names the key of the scene, the value and what is allowed.
void validate(const Brake& brake, const StudyOptions& study);

}  // namespace chladni::squeal
