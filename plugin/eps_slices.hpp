#pragma once

#include <slepceps.h>

#include <vector>

#include "common/petsc.hpp"

/// All eigenvalues of an interval, certified by Sylvester's law of inertia at its ends.
namespace chladni::plugin {

/// Counts of eigenvalues by the negative pivots of A - sigma B.
struct Certificate {
  double low, high;                ///< where it was counted: at the ends, or just beyond them
  PetscInt below_low, below_high;  ///< eigenvalues below each
  PetscInt n_factors = 0;          ///< 0: there was no interval
};

struct IntervalPair {
  double lambda, error;  ///< error: the estimate of its relative residual
  petsc::Vector x;
};

struct IntervalPairs {
  std::vector<IntervalPair> pairs;  ///< ascending
  Certificate certificate;
  bool is_complete;  ///< false where patience (-eps_max_it) ended before all had converged
};

/// Finds all eigenvalues of EPSSetInterval, its ends included.
/// @note   Collective.
/// @throws chladni::Error when the pivots count others than block Lanczos finds, when no place near
///         an end is free of eigenvalues, or when the package does not count pivots.
/// Options: those of the linear solver of the ST, `-st_pc_factor_mat_solver_type`,
/// `-st_mat_mumps_...`; by default mumps-metis.
IntervalPairs pairs_of_interval(EPS eps, PetscInt block_size);

PetscErrorCode view_certificate(const Certificate& certificate, PetscViewer viewer);

}  // namespace chladni::plugin
