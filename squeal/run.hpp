#pragma once

#include <functional>
#include <string>

#include "squeal/disc.hpp"
#include "squeal/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Called with the name of the analysis under way and the fraction of it that is done, 0 to 1.
using RunProgress = std::function<void(const std::string& analysis, double fraction)>;

/// Performs `options.analyses` on the disc. "limit-cycle" runs the transient that it needs.
/// What was found stays when a later analysis fails; SquealResults::failure then says why.
/// @throws chladni::Error from `validate` and from the first analysis.
SquealResults run(const Disc& disc, const SquealOptions& options, const RunProgress& progress = {});

}  // namespace chladni::squeal
