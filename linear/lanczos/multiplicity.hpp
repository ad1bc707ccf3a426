#pragma once

#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Ritz values in the order in which they are wanted, and ||Op x - theta x||_M of each.
struct RitzValues {
  std::vector<double> theta, residual;
};

/// The Krylov space of some random vectors that were made orthogonal to eigenvectors known before.
struct KrylovSequence {
  PetscInt n_sources = 0;       ///< random vectors that it began with
  PetscInt n_guesses = 0;       ///< of these, guesses of eigenvectors with a random share
  std::vector<double> known{};  ///< eigenvalues of the vectors known before, in the wanted order
};

/// What can be said about further copies of multiple eigenvalues.
enum class Copies {
  all_there,      ///< no eigenvalue before the last one wanted has further copies
  not_yet_known,  ///< the sequence has not yet shown the largest eigenvalue besides the known ones
  may_lack        ///< an eigenvalue may have more copies than the sequence can find
};

/// Whether the first n pairs, all of them converged, may lack copies of a multiple eigenvalue. A
/// Krylov space of w random vectors holds min(m, w) eigenvectors of an eigenvalue of multiplicity
/// m, besides those known before. So all are there where fewer than w new ones were found, and as
/// many as w may be too few. The cluster that the nth pair belongs to is left out: further copies
/// of it would not change the first n values.
/// @param pairs      all that there are, in order
/// @param tolerance  of the residuals relative to theta, from which follows how close eigenvalues
///                   are that converge as one
Copies copies_among(const RitzValues& pairs, PetscInt n, const KrylovSequence& sequence,
                    double tolerance);

/// How many of the first pairs were known before the sequence began.
PetscInt n_known_among(std::span<const double> theta, const KrylovSequence& sequence,
                       double tolerance);

/// How many of the first pairs have a residual up to the tolerance times |theta|.
PetscInt n_converged_first(const RitzValues& pairs, double tolerance);

/// Residuals relative to theta from which on a restart that drops a pair makes the iteration forget
/// it, and up to which a new sequence shows its largest eigenvalue.
constexpr double resolved = 1e-4;

}  // namespace chladni::linear
