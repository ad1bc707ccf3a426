#pragma once

#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/mode_samples.hpp"

namespace chladni::squeal {

/// Adds samples to those of `followed_modes`, in the same order of motions, so that changes of the
/// stability between two samples of equal stability are found for the motions `which`. It searches
/// maxima of the growth that may exceed zero, minima that may fall below zero, and crossings of the
/// frequencies of two stable motions.
std::vector<ModeSample> with_hidden_changes(const StateMatrixOf& A, std::vector<ModeSample> samples,
                                            const std::vector<Eigen::Index>& which);

/// Intervals in which motion j of the samples grows. Each limit is bisected to a narrow bracket and
/// refined by Newton's method (hopf.hpp). If that leaves the bracket or the motion, bisection
/// continues to the last digit.
std::vector<UnstableInterval> unstable_intervals(const StateMatrixOf& A,
                                                 const std::vector<ModeSample>& samples,
                                                 Eigen::Index j);

}  // namespace chladni::squeal
