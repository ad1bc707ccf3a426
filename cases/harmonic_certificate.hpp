#pragma once

#include "cases/harmonic_part.hpp"

namespace chladni::cases {

/// The certificate of all harmonics together. Each place has at least the eigenvalue of its place
/// among the lower ends lambda / (1 + bound) of all harmonics, as far as none misses one.
/// @param fixed       the support of the certificates
/// @param lambda_max  up to which each harmonic is certified, rad^2/s^2
mbs_export::Certificate whole_certificate(const std::vector<HarmonicPart>& parts,
                                          const std::vector<std::string>& fixed, double lambda_max);

/// Adds how well the harmonics keep responses: the worst of those that are loaded.
void add_responses(mbs_export::Certificate& whole, const std::vector<HarmonicPart>& parts,
                   const std::vector<std::string>& loads);

}  // namespace chladni::cases
