#pragma once

#include <optional>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/hopf.hpp"

namespace chladni::squeal {

/// Values of a parameter, of which `count` at equal distances are looked at first.
struct SearchRange {
  double from;
  double to;
  int count;  ///< at least 3
};

/// The intervals of a parameter in which x' = A x is unstable.
///
/// Unstable is what grows faster than rounding can make of a neutral motion: 1e-12 of the largest
/// |lambda|, times the condition of the eigenvalue. A rigid or undamped motion therefore counts as
/// stable, and hides nothing.
///
/// The largest real part of the spectrum is continuous in the parameter even where branches cross,
/// so that each change of stability between two samples is bracketed by bisection. Newton's method
/// (hopf.hpp) ends the search only if it stays within the last bracket, and if nothing grows at its
/// result: sliding is stable on one side of it, to the width of the bracket, and unstable on the
/// other. Between samples of like stability the search follows
///  - each branch of eigenvalues that has a maximum of its real part which may rise above zero,
///  - minima of the largest real part that may fall below zero,
///  - values at which two branches have one frequency, where modes couple within a narrow interval.
/// What is narrower than the distance of the samples and none of these remains unseen.
StabilityProfile stability_over(const StateMatrixOf& A, const SearchRange& range);

}  // namespace chladni::squeal
