#pragma once

#include "squeal/brake/radiation.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal::test {

/// Results of every analysis for two modes, with the fewest values that each may have or a few:
/// what tests/data/version_1.squeal.h5 holds.
SquealResults version_1_results();

/// What tests/data/version_1.radiation.h5 holds.
Radiation version_1_radiation();

}  // namespace chladni::squeal::test
