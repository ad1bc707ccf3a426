#pragma once

#include "report/json.hpp"
#include "squeal/results/signal_results.hpp"

namespace chladni::report {

/// The spectrogram in decibels, thinned for a page, with the frequencies and the orders of its
/// lines.
Json spectrogram_page(const squeal::Spectrogram& spectrogram);

}  // namespace chladni::report
