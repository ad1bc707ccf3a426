#pragma once

#include <span>

#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal {

/// Amplitude spectrum of equally spaced samples with a Hann window, and its peaks: at most 32 local
/// maxima above 1e-5 of the largest amplitude, each interpolated by the main lobe of the window.
/// @param step  distance of the samples, s
/// @throws chladni::Error for fewer than 64 samples.
Spectrum spectrum(std::span<const double> x, double step);

/// Spectrogram of the whole history of a transient, in at most 200 windows of at least 64 samples,
/// with the five strongest lines of each window.
/// @throws chladni::Error for a history of fewer than 256 samples.
Spectrogram spectrogram(const Transient& run);

}  // namespace chladni::squeal
