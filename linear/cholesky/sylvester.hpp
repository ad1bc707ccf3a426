#pragma once

#include <vector>

#include "common/error.hpp"
#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::linear {

/// K - sigma M has no factor: sigma is an eigenvalue to round-off.
class SingularShift : public Error {
 public:
  using Error::Error;
};

/// Number of eigenvalues of K x = lambda M x below sigma: by Sylvester's law of inertia the number
/// of negative pivots of L D L^T = K - sigma M. By our own elimination, and where that magnifies
/// round-off, having no choice of pivots, by MUMPS. M positive semidefinite.
/// @param sigma  rad^2/s^2; no eigenvalue itself: put it into a gap.
/// @note   Collective; one factorisation, which is not kept.
/// @throws SingularShift when the factorisation fails: sigma is an eigenvalue to round-off.
/// Options: `-<prefix>sylvester_mat_mumps_...`, `-<prefix>sylvester_pc_factor_mat_solver_type`; any
/// of them chooses MUMPS.
PetscInt eigenvalues_below(Mat K, Mat M, double sigma, const OptionSource& source = {});

/// The same without the rows and columns of `held` DOFs.
/// @param held  global indices, the same list on every rank.
PetscInt eigenvalues_below(Mat K, Mat M, double sigma, const std::vector<PetscInt>& held,
                           const OptionSource& source = {});

}  // namespace chladni::linear
