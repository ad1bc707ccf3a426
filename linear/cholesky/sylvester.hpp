#pragma once

#include <vector>

#include "common/error.hpp"
#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::linear {

/// Thrown when K - sigma M has no factor: sigma is an eigenvalue to round-off.
class SingularShift : public Error {
 public:
  using Error::Error;
};

/// Where eigenvalues are counted.
struct CountShift {
  double sigma;      ///< rad^2/s^2; not an eigenvalue itself: choose it in a gap
  double gap = 0.0;  ///< relative distance to the nearest eigenvalue, at least; 0: unknown
};

/// The rows of K and M that are counted, and what is known of their elimination.
struct CountedRows {
  std::vector<PetscInt> held = {};  ///< rows that are not, the same list on every rank
  /// A factor of K, or of the rows of K that `factored` lists. If it is our own, its elimination is
  /// taken over as far as it goes: no order is searched, and nothing is analysed anew if the
  /// pattern is the same.
  Mat factor = nullptr;
  std::vector<PetscInt> factored = {};  ///< in the order of the factor's rows, on every rank
};

/// Number of eigenvalues of K x = lambda M x below sigma, without the rows and columns that are
/// held. By Sylvester's law of inertia it is the number of negative pivots of L D L^T = K - sigma
/// M. Uses our own elimination, which does not pivot, where its round-off moves eigenvalues by less
/// than a thirtieth of the gap, and MUMPS elsewhere. M must be positive semidefinite.
/// @note   Collective; one factorisation, which is not kept.
/// @throws SingularShift when the factorisation fails: sigma is an eigenvalue to round-off.
/// Options: `-<prefix>sylvester_mat_mumps_...`, `-<prefix>sylvester_pc_factor_mat_solver_type`; any
/// of them chooses MUMPS.
PetscInt eigenvalues_below(Mat K, Mat M, const CountShift& shift, const CountedRows& rows = {},
                           const OptionSource& source = {});

}  // namespace chladni::linear
