#pragma once

#include "squeal/model_options.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study/run.hpp"

namespace chladni::squeal {

/// Performs `options.study.analyses`; "limit-cycle" runs the transient that it needs.
/// @throws chladni::Error from the analyses.
SquealResults run(const ModelOptions& options, const StudyKeeping& keeping = {});

}  // namespace chladni::squeal
