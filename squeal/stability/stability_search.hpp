#pragma once

#include <optional>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/hopf.hpp"

namespace chladni::squeal {

/// A range of a parameter, of which `count` equally spaced values are sampled first.
struct SearchRange {
  double from;
  double to;
  int count;  ///< at least 3
};

/// Intervals of a parameter in which x' = A x is unstable.
///
/// A motion counts as unstable when it grows faster than rounding errors can cause: 1e-12 of the
/// largest |lambda|, times the condition number of the eigenvalue. A rigid or undamped motion is
/// therefore stable and does not hide others.
///
/// The largest real part of all eigenvalues is continuous in the parameter even where branches
/// cross, so each change of stability between two samples is bracketed by bisection. Newton's
/// method (hopf.hpp) refines the limit only if its result is within the last bracket and no other
/// motion grows there; then sliding is stable on one side and unstable on the other, within the
/// width of the bracket. Between samples of equal stability the search follows
///  - maxima of the real part of each branch that may exceed zero,
///  - minima of the largest real part that may fall below zero,
///  - values at which two branches have the same frequency, where modes couple in a narrow
///    interval.
/// Other instabilities that are narrower than the distance of the samples are not found.
StabilityProfile stability_over(const StateMatrixOf& A, const SearchRange& range);

/// As stability_over, but where stability is lost the range ends just above: for those who ask for
/// nothing beyond, which may be most of the range.
StabilityProfile stability_until_loss(const StateMatrixOf& A, const SearchRange& range);

}  // namespace chladni::squeal
