#pragma once

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::reduce {

/// A solver with the factor L D L^T of a symmetric indefinite matrix by MUMPS. After its values
/// have changed, KSPSetUp factors it anew in the same order. Options: `-<prefix>mat_mumps_...`
/// @note   Collective.
petsc::LinearSolver indefinite_factor(Mat A, const linear::OptionSource& source);

/// V = A^-1 E for dense E and V with the rows of A.
/// @return whether there is a factor and |A V - E| < 1e-12 |A| |V| in the Frobenius norm
/// @note   Collective.
bool solve_to_round_off(KSP solver, Mat E, Mat V);

}  // namespace chladni::reduce
