#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/sector_model.hpp"

namespace chladni::cases {

/// The responses of a scene's body that the harmonics of its sectors are to keep.
struct HarmonicResponses {
  cyclic::HarmonicGoal goal;
  std::vector<std::string> names;  ///< "track.z" stands for all nodes of the set
};

/// Those of `[body] keep` with a tolerance, of which a third is the reduction's. What a force at a
/// node of a ring causes is a sum over the harmonics, whose squares add up: where each keeps the
/// tolerance of its own responses, all together do. Nothing without a tolerance, by another method
/// than the mixed interface, under a support that harmonics do not know by themselves or that holds
/// all interface nodes, for moments,
/// and for forces on rings of which some harmonics are no masters, or in one direction of the
/// plane.
/// @param whole  `described_whole`
std::optional<HarmonicResponses> harmonic_responses(const scene::Scene& scene,
                                                    const SectorModel& model,
                                                    const mbs_export::ReducedSystem& whole,
                                                    const SectorSupport& support);

}  // namespace chladni::cases
