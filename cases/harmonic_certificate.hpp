#pragma once

#include "cases/harmonic_part.hpp"

namespace chladni::cases {

/// The certificate of all harmonics together. If no harmonic misses a mode, the eigenvalue at each
/// place in the order is at least the one at this place among the lower limits lambda / (1 + bound)
/// of all harmonics.
/// @param fixed       the support of the certificates
/// @param lambda_max  up to which each harmonic is certified, rad^2/s^2
mbs_export::Certificate whole_certificate(const std::vector<HarmonicPart>& parts,
                                          const std::vector<std::string>& fixed, double lambda_max);

/// Adds the accuracy of the responses: that of the worst loaded harmonic.
void add_responses(mbs_export::Certificate& whole, const std::vector<HarmonicPart>& parts,
                   const std::vector<std::string>& loads);

}  // namespace chladni::cases
