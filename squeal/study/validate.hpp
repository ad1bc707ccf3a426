#pragma once

#include "squeal/models/brake.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Checks the options of a study, each value and their combination for the analyses asked for, and
/// those of a brake with a body.
/// @throws chladni::Error naming the key of the scene, the value and what is allowed.
void validate(const Brake& brake, const StudyOptions& study);

}  // namespace chladni::squeal
