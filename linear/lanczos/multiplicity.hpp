#pragma once

#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Ritz values in the wanted order, and ||Op x - theta x||_M of each.
struct RitzValues {
  std::vector<double> theta, residual;
};

/// The Krylov space of some random vectors that are orthogonal to eigenvectors known before.
struct KrylovSequence {
  PetscInt n_sources = 0;  ///< number of random starting vectors
  PetscInt n_guesses = 0;  ///< of these, guesses of eigenvectors with a random part
  /// eigenvalues of the vectors known before, in the wanted order
  std::vector<double> known{};
};

/// What is known about further copies of multiple eigenvalues.
enum class Copies {
  all_there,      ///< no eigenvalue before the last one wanted has further copies
  not_yet_known,  ///< the sequence has not yet shown the largest eigenvalue besides the known ones
  may_lack        ///< an eigenvalue may have more copies than the sequence can find
};

/// Whether the first n pairs, all of them converged, may lack copies of a multiple eigenvalue. A
/// Krylov space of w random vectors holds min(m, w) eigenvectors of an eigenvalue of multiplicity
/// m, in addition to those known before. If fewer than w new ones were found, none is missing; if w
/// were found, there may be more. The cluster of the nth pair is not considered: further copies of
/// it would not change the first n values.
/// @param pairs      all pairs, in order
/// @param tolerance  of the residuals relative to theta; it determines how close eigenvalues are
///                   that converge as one
Copies copies_among(const RitzValues& pairs, PetscInt n, const KrylovSequence& sequence,
                    double tolerance);

/// The number of the first pairs that were known before the sequence began.
PetscInt n_known_among(std::span<const double> theta, const KrylovSequence& sequence,
                       double tolerance);

/// The number of leading pairs whose residual is at most the tolerance times |theta|.
PetscInt n_converged_first(const RitzValues& pairs, double tolerance);

/// A residual relative to theta. Above it, a restart that drops a pair makes the iteration forget
/// it; below it, a new sequence shows its largest eigenvalue.
constexpr double resolved = 1e-4;

}  // namespace chladni::linear
