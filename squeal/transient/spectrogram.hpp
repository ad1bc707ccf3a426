#pragma once

#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Spectrogram of the whole history of a transient, in at most 200 windows of at least 64 samples,
/// with the five strongest lines of each window.
/// @throws chladni::Error for a history of fewer than 256 samples.
Spectrogram spectrogram(const Transient& run);

}  // namespace chladni::squeal
