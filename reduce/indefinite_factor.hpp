#pragma once

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::reduce {

/// A solver with the factor L D L^T of a symmetric indefinite matrix, by MUMPS. After the values of
/// A have changed, KSPSetUp factors it again with the same elimination order.
/// @note   Collective.
/// Options: `-<prefix>mat_mumps_...`
petsc::LinearSolver indefinite_factor(Mat A, const linear::OptionSource& source);

/// Solves A V = E for dense E and V with the rows of A.
/// @return true if there is a factor and |A V - E| < 1e-12 |A| |V| in the Frobenius norm
/// @note   Collective.
bool solve_to_round_off(KSP solver, Mat E, Mat V);

}  // namespace chladni::reduce
