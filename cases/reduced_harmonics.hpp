#pragma once

#include <memory>
#include <vector>

#include "cases/harmonic_groups.hpp"
#include "cases/harmonic_part.hpp"
#include "cases/harmonic_responses.hpp"
#include "cases/picture.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cases {

/// The contents of the whole body's file besides the harmonics.
struct Described {
  mbs_export::ReducedSystem system;  ///< `described_whole`
  SectorSupport support;
  double lambda_max;  ///< up to which each harmonic is certified, rad^2/s^2
  PictureNodes chosen;
  /// null if the scene wants no mass integrals
  std::unique_ptr<SectorMass> mass;
  /// section forces need the motion of the whole sector
  bool with_forces;
  std::vector<int> deviating;  ///< SectorDeviations::rows
  std::optional<HarmonicResponses> responses;
};

/// The reduced harmonics of this rank's group; none on ranks that do not speak for their group.
/// @note   Collective on all ranks.
/// @throws chladni::Error naming the harmonic, on all ranks.
std::vector<HarmonicPart> reduced_harmonics(const SectorModel& model,
                                            const cyclic::SectorMatrices& matrices,
                                            const reduce::ReductionOptions& options,
                                            const Described& described,
                                            const HarmonicGroups& groups);

}  // namespace chladni::cases
