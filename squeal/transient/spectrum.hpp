#pragma once

#include <span>

#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Amplitudes of equally spaced samples over the frequency, with a Hann window; peaks that stand
/// out from their neighbours and above 1e-5 of the largest, 32 at most, each refined by the shape
/// of the window's main lobe.
/// @param step  of the samples, s
/// @throws chladni::Error for fewer than 64 samples.
Spectrum spectrum(std::span<const double> x, double step);

}  // namespace chladni::squeal
