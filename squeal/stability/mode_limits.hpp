#pragma once

#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/mode_samples.hpp"

namespace chladni::squeal {

/// The samples of `followed_modes` with more between them, in the same order of motions, at which
/// one of the motions `which` may be unstable between two samples at which it is stable, or stable
/// between two at which it is unstable: where its growth has a maximum that may rise above zero, or
/// a minimum that may fall below, and where two of them, both stable, have one frequency.
std::vector<ModeSample> with_hidden_changes(const StateMatrixOf& A, std::vector<ModeSample> samples,
                                            const std::vector<Eigen::Index>& which);

/// The intervals in which motion j of the samples grows. Each limit is bisected to a narrow bracket
/// and refined by Newton's method (hopf.hpp) if that ends within the bracket, on the same motion;
/// else it is bisected to the last digit.
std::vector<UnstableInterval> unstable_intervals(const StateMatrixOf& A,
                                                 const std::vector<ModeSample>& samples,
                                                 Eigen::Index j);

}  // namespace chladni::squeal
