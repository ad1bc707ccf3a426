#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/sector_model.hpp"

namespace chladni::cases {

/// The responses of a scene's body that the harmonics of its sectors keep to a tolerance.
struct HarmonicResponses {
  cyclic::HarmonicGoal goal;
  std::vector<std::string> names;  ///< "track.z" for all nodes of a set
};

/// The responses of `[body] keep` with a tolerance, a third of which the reduction may use. The
/// response to a force at a node of a ring is a sum over the harmonics whose squares add up; if
/// each harmonic keeps the tolerance of its own responses, so do all together. Absent without a
/// tolerance, with another method than the mixed interface, under a support that couples harmonics
/// or holds all interface nodes, for moments, for forces on rings some of whose harmonics are no
/// masters, and for forces in a single direction of the plane.
/// @param whole  `described_whole`
std::optional<HarmonicResponses> harmonic_responses(const scene::Scene& scene,
                                                    const SectorModel& model,
                                                    const mbs_export::ReducedSystem& whole,
                                                    const SectorSupport& support);

}  // namespace chladni::cases
