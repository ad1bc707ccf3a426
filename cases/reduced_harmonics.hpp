#pragma once

#include <memory>
#include <vector>

#include "cases/harmonic_groups.hpp"
#include "cases/harmonic_part.hpp"
#include "cases/harmonic_responses.hpp"
#include "cases/picture.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cases {

/// What the file of the whole body is made of, besides the harmonics.
struct Described {
  mbs_export::ReducedSystem system;  ///< `described_whole`
  SectorSupport support;
  double lambda_max;  ///< up to which each harmonic is certified, rad^2/s^2
  PictureNodes chosen;
  std::unique_ptr<SectorMass> mass;  ///< none where the scene does not want the integrals
  bool with_forces;                  ///< section forces want the motion of the whole sector
  std::vector<int> deviating;        ///< SectorDeviations::rows
  std::optional<HarmonicResponses> responses;
};

/// The harmonics of this rank's group; none on ranks that do not speak for theirs.
/// @note   Collective on all ranks.
/// @throws chladni::Error naming the harmonic, on all ranks.
std::vector<HarmonicPart> reduced_harmonics(const SectorModel& model,
                                            const cyclic::SectorMatrices& matrices,
                                            const reduce::ReductionOptions& options,
                                            const Described& described,
                                            const HarmonicGroups& groups);

}  // namespace chladni::cases
