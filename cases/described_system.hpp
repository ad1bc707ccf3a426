#pragma once

#include <string>
#include <vector>

#include "cases/reduce_steps.hpp"

namespace chladni::cases {

/// The reduced system without its matrices: title, nodes, sets and masters.
mbs_export::ReducedSystem described_system(const scene::Scene& scene, const FeModel& fe);

/// The supports of the scene's body that hold masters. Supports that hold nodes of a ring of
/// harmonics are left out, since they leave a residual that the certificate does not include.
std::vector<std::string> certified_support(const scene::Scene& scene, const FeModel& fe);

}  // namespace chladni::cases
