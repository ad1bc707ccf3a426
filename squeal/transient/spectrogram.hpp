#pragma once

#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Of the whole history of a transient, in 200 windows at most, each at least 64 samples long, with
/// the five strongest lines of each.
/// @throws chladni::Error for a history of fewer than 256 samples.
Spectrogram spectrogram(const Transient& run);

}  // namespace chladni::squeal
